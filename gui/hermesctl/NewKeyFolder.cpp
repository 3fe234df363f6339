#include "gui/hermesctl/NewKeyFolder.h"

#include "common/tls/FolderPlace.h"
#include "common/tls/KeyFolder.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonObject>

namespace hermes::ctl {
namespace {

QString placeOf(const QString &path) {
    const QFileInfo info(path); // a link stays one, and leads to the keys
    return QDir::cleanPath(info.exists() ? info.canonicalFilePath() : info.absoluteFilePath());
}

Error failed(const QString &path, const QString &why) {
    return {ErrorCode::InputOutput, QString("%1: %2").arg(path, why), QJsonObject{{"path", path}}};
}

} // namespace

NewKeyFolder::NewKeyFolder(const QString &place)
    : place_(placeOf(place)) {}

Result<void> NewKeyFolder::check() const {
    const QFileInfo info(place_);
    if (!info.exists() && !info.isSymLink())
        return {};
    if (!info.isDir())
        return failed(place_, "is no folder");
    if (QDir(place_).isEmpty(QDir::AllEntries | QDir::Hidden | QDir::System | QDir::NoDotAndDotDot))
        return {};
    const bool hasKeys = QFile::exists(QDir(place_).filePath(KeyFolder::keyFile()));
    return failed(place_, hasKeys ? "there are keys already; they are not replaced"
                                  : "the folder is not empty; nothing in it is replaced");
}

Result<void> NewKeyFolder::stage(const KeyBundle &keys) {
    QDir().mkpath(QFileInfo(place_).path());
    // Only its owner may enter. Nobody knows its name before: there is no other one, nor a link, in its
    // place.
    staged_ = std::make_unique<QTemporaryDir>(place_ + "-XXXXXX");
    if (!staged_->isValid())
        return failed(place_, staged_->errorString());
    if (const auto written = keys.write(staged_->path()); !written)
        return written;
    if (const auto usable = KeyFolder::load(staged_->path()); !usable)
        return usable.error();
    const auto revoked = KeyFolder::revoked(staged_->path());
    return revoked ? Result<void>() : revoked.error();
}

Result<void> NewKeyFolder::keep() {
    if (!takePlace(staged_->path(), place_))
        return failed(place_,
                      qt_error_string() + "; nothing was kept here: revoke the keys where they were made");
    staged_->setAutoRemove(false);
    return {};
}

} // namespace hermes::ctl
