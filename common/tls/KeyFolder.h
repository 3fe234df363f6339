#pragma once

#include "common/Result.h"
#include "common/interface/Peer.h"

#include <QSet>
#include <QSslConfiguration>

namespace hermes {

/// A folder of keys for TLS, of a daemon or of a person: authority.crt, own.crt, own.key (which only its
/// owner may read), and revoked: one serial number a line, in hexadecimal digits, then what people like to
/// know. `hermesctl keys` makes all of them.
class KeyFolder {
public:
    static QString authorityFile() { return QStringLiteral("authority.crt"); }
    static QString ownFile() { return QStringLiteral("own.crt"); }
    static QString keyFile() { return QStringLiteral("own.key"); }
    static QString revokedFile() { return QStringLiteral("revoked"); }
    /// $HERMES_KEYS, else hermes/keys in the user's folder of settings.
    static QString usual();

    /// Certificates of both sides, TLS 1.2 at least. Error: which file is missing, may be read by others,
    /// cannot be read, does not belong to the others or has expired, and the remedy.
    static Result<QSslConfiguration> load(const QString &folder);
    /// Serial numbers. None when there is no such file in the folder; error: it or the folder cannot be
    /// read, or a line is no number.
    static Result<QSet<QByteArray>> revoked(const QString &folder);
};

/// Whole or not at all; only its owner may read it, from the beginning.
Result<void> writeKeyFile(const QString &path, const QByteArray &content);

/// What a certificate says.
PeerCertificate toPeer(const QSslCertificate &certificate);

} // namespace hermes
