#include "gui/hermesctl/NewKeyFolder.h"

#include "common/tls/KeyFolder.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonObject>
#include <cerrno>
#include <cstdio>
#include <sys/stat.h>

namespace hermes::ctl {
namespace {

QString placeOf(const QString &path) {
    const QFileInfo info(path); // a link stays one, and leads to the keys
    return QDir::cleanPath(info.exists() ? info.canonicalFilePath() : info.absoluteFilePath());
}

Error failed(const QString &path, const QString &why) {
    return {ErrorCode::InputOutput, QStringLiteral("%1: %2").arg(path, why),
            QJsonObject{{QStringLiteral("path"), path}}};
}

} // namespace

NewKeyFolder::NewKeyFolder(const QString &place)
    : place_(placeOf(place))
    , staged_(place_ + QStringLiteral(".joining")) {}

NewKeyFolder::~NewKeyFolder() {
    if (isStaged_)
        QDir(staged_).removeRecursively();
}

Result<void> NewKeyFolder::check() const {
    const QFileInfo info(place_);
    if (!info.exists() && !info.isSymLink())
        return {};
    if (!info.isDir())
        return failed(place_, QStringLiteral("is no folder"));
    if (QDir(place_).isEmpty(QDir::AllEntries | QDir::Hidden | QDir::System | QDir::NoDotAndDotDot))
        return {};
    const bool hasKeys = QFile::exists(QDir(place_).filePath(KeyFolder::keyFile()));
    return failed(place_, hasKeys ? QStringLiteral("there are keys already; they are not replaced")
                                  : QStringLiteral("the folder is not empty; nothing in it is replaced"));
}

Result<void> NewKeyFolder::stage(const KeyBundle &keys) {
    const QByteArray path = QFile::encodeName(staged_);
    QDir().mkpath(QFileInfo(place_).path());
    if (QFileInfo::exists(staged_)) // somebody was cut off
        QDir(staged_).removeRecursively();
    if (::mkdir(path.constData(), 0700) != 0)
        return failed(staged_, qt_error_string(errno));
    isStaged_ = true;
    ::chmod(path.constData(), 0700);
    if (const auto written = keys.write(staged_); !written)
        return written;
    if (const auto usable = KeyFolder::load(staged_); !usable)
        return usable.error();
    const auto revoked = KeyFolder::revoked(staged_);
    return revoked ? Result<void>() : revoked.error();
}

Result<void> NewKeyFolder::keep() {
    // Takes the place of an empty folder, too, but of nothing else.
    if (::rename(QFile::encodeName(staged_).constData(), QFile::encodeName(place_).constData()) != 0)
        return failed(place_,
                      qt_error_string(errno) +
                          QStringLiteral("; nothing was kept here: revoke the keys where they were made"));
    isStaged_ = false;
    return {};
}

} // namespace hermes::ctl
