#include "common/tls/KeyFolder.h"

#include "common/files/SavedFile.h"
#include "common/platform/PrivateFiles.h"
#include "common/tls/Certificates.h"
#include "common/tls/FolderPlace.h"

#include <QDateTime>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonObject>
#include <QSslCertificate>
#include <QSslKey>
#include <QStandardPaths>

namespace hermes {
namespace {

constexpr int shortestSerial = 16;   // digits, as issueCertificate() makes them
constexpr qint64 maxBytes = 1 << 20; // of a file of keys

const QString remedy = QStringLiteral("hermesctl keys --help tells how to make keys");

Error wrong(const QString &file, const QString &what, const QString &how = remedy) {
    return {ErrorCode::InputOutput, QString("%1: %2; %3").arg(file, what, how), QJsonObject{{"path", file}}};
}

Result<QByteArray> readKeyFile(const QString &path) {
    QFile file(path);
    const QFileInfo info(path);
    if (info.exists() && (!info.isFile() || info.size() > maxBytes)) // a pipe is not opened: that waits
        return wrong(path, "is not a file of keys");
    if (!info.exists() && !file.open(QIODevice::ReadOnly))
        return wrong(path, file.errorString());
    if (!file.open(QIODevice::ReadOnly))
        return wrong(path, file.errorString(), "the daemon's user must be able to read it");
    return file.readAll();
}

Result<QByteArray> readSecret(const QString &path) {
    const Result<QByteArray> content = readKeyFile(path);
    constexpr QFile::Permissions others = QFile::ReadGroup | QFile::WriteGroup | QFile::ExeGroup |
                                          QFile::ReadOther | QFile::WriteOther | QFile::ExeOther;
    if (content && permissionsTellReaders() && (QFile::permissions(path) & others))
        return wrong(path, "others than its owner may read or change it",
                     QString("chmod 600 \"%1\", and issue a new one if others may have read it").arg(path));
    return content;
}

Result<QSslCertificate> certificateIn(const QByteArray &pem, const QString &path) {
    const QSslCertificate certificate(pem);
    if (certificate.isNull())
        return wrong(path, "is not a certificate");
    const QDateTime now = QDateTime::currentDateTimeUtc();
    if (certificate.expiryDate() < now || certificate.effectiveDate() > now)
        return wrong(path,
                     QString("is valid from %1 to %2, the clock says %3")
                         .arg(certificate.effectiveDate().toString(Qt::ISODate),
                              certificate.expiryDate().toString(Qt::ISODate), now.toString(Qt::ISODate)));
    return certificate;
}

} // namespace

QString KeyFolder::usual() {
    const QString set = qEnvironmentVariable("HERMES_KEYS");
    return !set.isEmpty()
               ? set
               : QStandardPaths::writableLocation(QStandardPaths::GenericConfigLocation) + "/hermes/keys";
}

Result<QSslConfiguration> KeyFolder::load(const QString &folder) {
    const QDir dir(folder);
    const QString authorityPath = dir.filePath(authorityFile()), ownPath = dir.filePath(ownFile()),
                  keyPath = dir.filePath(keyFile());
    const auto authorityPem = readKeyFile(authorityPath), ownPem = readKeyFile(ownPath),
               keyPem = readSecret(keyPath);
    for (const auto *content : {&authorityPem, &ownPem, &keyPem})
        if (!*content)
            return content->error();
    const auto authority = certificateIn(*authorityPem, authorityPath), own = certificateIn(*ownPem, ownPath);
    if (!authority || !own)
        return authority ? own.error() : authority.error();
    if (!belongTogether({*ownPem, *keyPem}))
        return wrong(keyPath, "is not the key of " + ownPath);
    if (!isSignedBy(*ownPem, *authorityPem))
        return wrong(ownPath, "is not signed by the authority of " + authorityPath);
    QSslConfiguration made;
    made.setCaCertificates({*authority});
    made.setLocalCertificate(*own);
    made.setPrivateKey(QSslKey(*keyPem, QSsl::Ec));
    made.setProtocol(QSsl::TlsV1_2OrLater);
    made.setPeerVerifyMode(QSslSocket::VerifyPeer);
    return made;
}

Result<QSet<QByteArray>> KeyFolder::revoked(const QString &folder) {
    const QString path = QDir(folder).filePath(revokedFile());
    const QFileInfo place(folder);
    const bool isNone =
        isAbsent(path) && place.isReadable() && (place.isExecutable() || !permissionsTellReaders());
    if (isNone)
        return QSet<QByteArray>();
    const auto content = readKeyFile(path);
    if (!content)
        return content.error();
    QSet<QByteArray> serials;
    for (const QByteArray &line : content->split('\n')) {
        const QByteArray word = line.simplified().split(' ').value(0).toLower();
        if (word.isEmpty() || word.startsWith('#'))
            continue;
        // One that was cut off must not be taken for another.
        const bool isNumber = word.size() >= shortestSerial && QByteArray::fromHex(word).toHex() == word;
        if (!isNumber)
            return wrong(path,
                         QString("\"%1\" is not a serial number, expected 16 hexadecimal digits or more")
                             .arg(QString::fromUtf8(word.left(40))));
        serials.insert(word);
    }
    return serials;
}

Result<void> writeKeyFile(const QString &path, const QByteArray &content) {
    const PrivateFiles owners;
    return saveFile(path, content);
}

PeerCertificate toPeer(const QSslCertificate &certificate) {
    return {certificate.subjectInfo(QSslCertificate::CommonName).value(0),
            certificate.subjectInfo(QSslCertificate::OrganizationalUnitName).value(0),
            QString::fromLatin1(certificate.serialNumber().replace(":", "").toLower()),
            double(certificate.expiryDate().toSecsSinceEpoch())};
}

} // namespace hermes
