#include "common/tls/KeyBundle.h"

#include "common/Role.h"
#include "common/tls/Certificates.h"
#include "common/tls/KeyFolder.h"
#include "protocol/wire/JsonText.h"

#include <QDir>
#include <QFile>
#include <QJsonObject>
#include <QRegularExpression>
#include <QSslCertificate>
#include <algorithm>

namespace hermes {
namespace {

constexpr int maxPemBytes = 1 << 16;

struct Member {
    const char *name;
    QByteArray KeyBundle::*content;
    QString file;
};

const Member members[] = {
    {"authority", &KeyBundle::authority, KeyFolder::authorityFile()},
    {"key", &KeyBundle::key, KeyFolder::keyFile()},
    {"certificate", &KeyBundle::certificate, KeyFolder::ownFile()},
    {"revoked", &KeyBundle::revoked, KeyFolder::revokedFile()},
};

Error bad(const QString &what) {
    return {ErrorCode::InvalidRequest, "the keys that arrived are not in order: " + what};
}

bool isPlainText(const QByteArray &text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); });
}

// Nothing before, between or after: no headers either, with which OpenSSL would ask for a passphrase.
bool isOnePem(const QByteArray &text, const char *kind) {
    const QString begin = QString("-----BEGIN %1-----\n").arg(QLatin1String(kind)),
                  end = QString("-----END %1-----\n").arg(QLatin1String(kind));
    static const QRegularExpression base64("\\A[A-Za-z0-9+/=\n]+\\z");
    const QString pem = QString::fromLatin1(text);
    return text.size() <= maxPemBytes && pem.startsWith(begin) && pem.endsWith(end) &&
           base64.match(pem.mid(begin.size(), pem.size() - begin.size() - end.size())).hasMatch();
}

Result<void> check(const KeyBundle &keys) {
    if (!isOnePem(keys.authority, "CERTIFICATE") || !isOnePem(keys.certificate, "CERTIFICATE"))
        return bad("a certificate is not valid");
    if (!isOnePem(keys.key, "PRIVATE KEY"))
        return bad("the key is not valid");
    const QSslCertificate own(keys.certificate);
    if (own.isNull() || !isSignedBy(keys.authority, keys.authority))
        return bad("a certificate cannot be read");
    if (!isSignedBy(keys.certificate, keys.authority))
        return bad("the certificate is not signed by the authority");
    if (!belongTogether({keys.certificate, keys.key}))
        return bad("the key is not that of the certificate");
    const PeerCertificate subject = toPeer(own);
    if (!checkCertificateName(subject.name) || (!roleFrom(subject.role) && subject.role != "daemon"))
        return bad("the certificate has no name");
    if (!isPlainText(keys.revoked))
        return bad("the list of revoked certificates is not a text");
    return {};
}

} // namespace

Result<KeyBundle> KeyBundle::read(const QString &folder) {
    KeyBundle keys;
    for (const Member &member : members) {
        if (member.content == &KeyBundle::revoked)
            continue;
        QFile file(QDir(folder).filePath(member.file));
        if (!file.open(QIODevice::ReadOnly))
            return Error(ErrorCode::InputOutput, QString("%1: %2").arg(file.fileName(), file.errorString()));
        keys.*member.content = file.read(maxJsonBytes);
    }
    const auto revoked = KeyFolder::revoked(folder);
    if (!revoked)
        return revoked.error();
    QList<QByteArray> serials = revoked->values();
    std::sort(serials.begin(), serials.end());
    for (const QByteArray &serial : serials)
        keys.revoked += serial + '\n';
    return keys;
}

Result<KeyBundle> KeyBundle::fromJson(const QByteArray &json) {
    WireError error;
    const auto parsed = parseJson(json, &error);
    if (json.size() > maxJsonBytes || !parsed || !parsed->isObject() ||
        parsed->toObject().size() != int(std::size(members)))
        return bad("expected an object with four texts");
    KeyBundle keys;
    for (const Member &member : members) {
        const QJsonValue value = parsed->toObject().value(QLatin1String(member.name));
        if (!value.isString())
            return bad(QString("%1 is not a text").arg(QLatin1String(member.name)));
        keys.*member.content = value.toString().toUtf8();
    }
    if (const auto fine = check(keys); !fine)
        return fine.error();
    return keys;
}

QByteArray KeyBundle::toJson() const {
    QJsonObject object;
    for (const Member &member : members)
        object.insert(QLatin1String(member.name), QString::fromUtf8(this->*member.content));
    return compactJson(object);
}

Result<void> KeyBundle::write(const QString &folder) const {
    for (const Member &member : members) {
        if (member.content == &KeyBundle::revoked && revoked.isEmpty())
            continue;
        if (const auto done = writeKeyFile(QDir(folder).filePath(member.file), this->*member.content); !done)
            return done;
    }
    return {};
}

} // namespace hermes
