#include "common/tls/Authority.h"

#include "common/platform/PrivateFiles.h"
#include "common/tls/FolderPlace.h"
#include "common/tls/KeyBundle.h"
#include "common/tls/KeyFolder.h"
#include "protocol/wire/JsonText.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>
#include <QJsonObject>
#include <QSslCertificate>
#include <QTemporaryDir>

namespace hermes {
namespace {

const QString issuedFile = QStringLiteral("issued");
const QString giveAwayFolder = QStringLiteral("issued-for");
const QString authorityKeyFile = QStringLiteral("authority.key");

Error failed(const QString &path, const QString &why) {
    return {ErrorCode::InputOutput, QString("%1: %2").arg(path, why), QJsonObject{{"path", path}}};
}

// On a line of its own, also where somebody has edited the file and left the last one open.
Result<void> append(const QString &path, const QByteArray &line) {
    QFile file(path);
    // Without a buffer: what of it a full disk refuses would be written once more, when the file is cut and
    // closed.
    if (!file.open(QIODevice::ReadWrite | QIODevice::Append | QIODevice::Unbuffered))
        return failed(path, file.errorString());
    const qint64 before = file.size();
    const bool isOpen = before > 0 && file.seek(before - 1) && file.read(1) != "\n";
    const QByteArray text = (isOpen ? QByteArray("\n") : QByteArray()) + line + '\n';
    if (file.write(text) == text.size() && syncToDisk(file.handle()))
        return {};
    const QString why = qt_error_string();
    if (!file.resize(before))
        return failed(path, why + "; half a line may stand at its end");
    return failed(path, why);
}

Result<QByteArray> readAuthorityFile(const QString &path) {
    QFile file(path);
    if (!file.open(QIODevice::ReadOnly))
        return failed(path, file.errorString() + "; hermesctl keys init makes an authority");
    return file.readAll();
}

Result<void> writeFolder(const QString &folder, const CertifiedKey &own, const QByteArray &authority) {
    if (!QDir().mkpath(folder))
        return failed(folder, "cannot be made");
    return KeyBundle{authority, own.certificate, own.key, {}}.write(folder);
}

} // namespace

QString Authority::path(const QString &file) const {
    return QDir(folder_).filePath(file);
}

Result<void> Authority::init(const QString &owner, int days, int daysOfOwner) const {
    const QFileInfo place(folder_);
    const auto all = QDir::AllEntries | QDir::Hidden | QDir::System | QDir::NoDotAndDotDot;
    if (place.isSymLink() || (place.exists() && (!place.isDir() || !QDir(folder_).isEmpty(all))))
        return failed(folder_, "there are keys already, or something else; it is not replaced");
    if (!QDir().mkpath(place.absolutePath()))
        return failed(place.absolutePath(), "cannot be made");
    QTemporaryDir beside(folder_ + "-XXXXXX"); // only its owner may enter; removed on failure
    if (!beside.isValid())
        return failed(folder_, beside.errorString());
    if (const auto made = Authority(beside.path()).fill(owner, days, daysOfOwner); !made)
        return made;
    if (!takePlace(beside.path(), folder_))
        return failed(folder_, qt_error_string());
    beside.setAutoRemove(false);
    return {};
}

Result<void> Authority::fill(const QString &owner, int days, int daysOfOwner) const {
    const auto authority = makeAuthority("Hermes authority of " + owner, days);
    if (!authority)
        return authority.error();
    const CertificateSubject subject{owner, "engineer"};
    const auto own = issueCertificate(*authority, subject, daysOfOwner);
    if (!own)
        return own.error();
    if (const auto done = writeFolder(folder_, *own, authority->certificate); !done)
        return done;
    if (const auto done = note(subject, own->certificate); !done)
        return done;
    return writeKeyFile(path(authorityKeyFile), authority->key);
}

Result<CertifiedKey> Authority::load() const {
    const auto certificate = readAuthorityFile(path(KeyFolder::authorityFile())),
               key = readAuthorityFile(path(authorityKeyFile));
    if (!certificate || !key)
        return certificate ? key.error() : certificate.error();
    if (!belongTogether({*certificate, *key}))
        return failed(path(authorityKeyFile), "is not the key of " + path(KeyFolder::authorityFile()));
    return CertifiedKey{*certificate, *key};
}

Result<void> Authority::note(const CertificateSubject &subject, const QByteArray &certificate) const {
    const QSslCertificate read(certificate);
    const QJsonObject line{{"name", subject.name},
                           {"role", subject.role},
                           {"serial", toPeer(read).serial},
                           {"until", read.expiryDate().toUTC().toString(Qt::ISODate)}};
    return append(path(issuedFile), compactJson(line));
}

QString Authority::folderFor(const QString &name) const {
    return path(giveAwayFolder + QLatin1Char('/') + name);
}

Result<void> Authority::canIssue(const QString &name) const {
    if (const auto fine = checkCertificateName(name); !fine)
        return fine.error();
    if (const auto authority = load(); !authority)
        return authority.error();
    if (const auto listed = KeyFolder::revoked(folder_); !listed)
        return listed.error();
    if (QFile::exists(folderFor(name)))
        return failed(folderFor(name),

                      "exists; remove it first, and revoke its certificate if it was given to somebody");
    return {};
}

Result<QString> Authority::issue(const CertificateSubject &subject, int days) const {
    if (const auto can = canIssue(subject.name); !can)
        return can.error();
    const auto authority = load();
    if (!authority)
        return authority.error();
    const QString folder = folderFor(subject.name);
    const auto made = issueCertificate(*authority, subject, days);
    if (!made)
        return made.error();
    QDir().mkpath(path(giveAwayFolder));
    QFile::setPermissions(path(giveAwayFolder), QFile::ReadOwner | QFile::WriteOwner | QFile::ExeOwner);
    auto done = writeFolder(folder, *made, authority->certificate);
    if (done && QFile::exists(path(KeyFolder::revokedFile())) &&
        !QFile::copy(path(KeyFolder::revokedFile()), QDir(folder).filePath(KeyFolder::revokedFile())))
        done = failed(folder, "the list of revoked certificates cannot be copied there");
    if (done)
        done = note(subject, made->certificate); // before it is given away: else it could not be revoked
    if (done)
        return folder;
    QDir(folder).removeRecursively();
    return done.error();
}

Result<std::vector<Authority::Issued>> Authority::list() const {
    const auto content = readAuthorityFile(path(issuedFile));
    if (!content)
        return content.error();
    const auto revoked = KeyFolder::revoked(folder_);
    if (!revoked)
        return revoked.error();
    std::vector<Issued> all;
    for (const QByteArray &line : content->split('\n')) {
        if (line.isEmpty())
            continue;
        const QJsonObject entry = QJsonDocument::fromJson(line).object();
        const auto text = [&entry](const char *name) { return entry.value(QLatin1String(name)).toString(); };
        const QDateTime until = QDateTime::fromString(text("until"), Qt::ISODate);
        if (text("serial").isEmpty() || !until.isValid())
            return failed(path(issuedFile), QString("line %1 is not a certificate that was issued: %2")
                                                .arg(all.size() + 1)
                                                .arg(QString::fromUtf8(line.left(80))));
        all.push_back({{text("name"), text("role")},
                       text("serial"),
                       until,
                       revoked->contains(text("serial").toLatin1())});
    }
    return all;
}

Result<int> Authority::revoke(const QString &nameOrSerial) const {
    const auto all = list();
    if (!all)
        return all.error();
    int count = 0;
    bool isKnown = false;
    for (const Issued &one : *all) {
        if (one.subject.name != nameOrSerial && one.serial != nameOrSerial.toLower())
            continue;
        isKnown = true;
        if (one.isRevoked)
            continue;
        const QString line = QString("%1 %2, %3").arg(one.serial, one.subject.name, one.subject.role);
        if (const auto done = append(path(KeyFolder::revokedFile()), line.toUtf8()); !done)
            return done.error();
        ++count;
    }
    if (!isKnown)
        return Error(ErrorCode::InvalidParams,
                     QString("no certificate of \"%1\" was issued; hermesctl keys list").arg(nameOrSerial));
    return count;
}

Result<void> Authority::takeBack(const QString &folder) const {
    const auto certificate = readAuthorityFile(QDir(folder).filePath(KeyFolder::ownFile()));
    if (!certificate)
        return certificate.error();
    const auto revoked = revoke(toPeer(QSslCertificate(*certificate)).serial);
    if (!revoked)
        return revoked.error();
    if (!QDir(folder).removeRecursively())
        return failed(folder, "cannot be removed");
    return {};
}

} // namespace hermes
