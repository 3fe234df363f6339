#pragma once

#include "common/Result.h"
#include "common/tls/Certificates.h"

#include <QDateTime>
#include <vector>

namespace hermes {

/// A folder of keys (KeyFolder) with the authority itself: authority.key, which only its owner may read,
/// `issued`, a line of JSON for each certificate, and a folder of keys for each to be given away.
class Authority {
public:
    struct Issued {
        CertificateSubject subject;
        QString serial;
        QDateTime until;
        bool isRevoked = false;
    };

    explicit Authority(QString folder)
        : folder_(std::move(folder)) {}

    /// Makes the authority, and a certificate for who makes it: an engineer. Error: there is one already.
    Result<void> init(const QString &owner, int days, int daysOfOwner) const;
    /// Error: why issue() would fail for that name.
    Result<void> canIssue(const QString &name) const;
    /// A new key with a certificate; gives the folder of keys that its owner needs, below `issued-for`.
    /// Nothing is left of it when it fails.
    Result<QString> issue(const CertificateSubject &subject, int days) const;
    /// Revokes the certificate in a folder that issue() gave, and removes the folder.
    Result<void> takeBack(const QString &folder) const;
    /// All valid ones of that name, or the one of that serial number; gives how many. Error: there is none.
    Result<int> revoke(const QString &nameOrSerial) const;
    Result<std::vector<Issued>> list() const;

private:
    Result<void> fill(const QString &owner, int days, int daysOfOwner) const;
    Result<CertifiedKey> load() const;
    Result<void> note(const CertificateSubject &subject, const QByteArray &certificate) const;
    QString path(const QString &file) const;
    QString folderFor(const QString &name) const;

    const QString folder_;
};

} // namespace hermes
