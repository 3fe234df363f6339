#include "daemons/recorder/SessionFiles.h"

#include "common/recording/DiskError.h"
#include "common/recording/Sidecar.h"

#include <QDir>

namespace hermes::recorder {
namespace {

/// The folder of all its parts. InputOutput: one lies elsewhere: what daemons name is not touched.
Result<QString> folderOf(const RecordedSession &session, const QString &root) {
    const QString folder = QDir(root).absoluteFilePath(session.name);
    const auto refused = [&folder](const QString &why) {
        return diskError(why + "; nothing was changed", folder);
    };
    for (const RecordedPart &part : session.parts)
        if (const QString own = part.entry.folder.value_or(QString());
            QDir::cleanPath(own) != QDir::cleanPath(folder))
            return refused(QString("%1 keeps its part in %2, not in %3").arg(part.member.name, own, folder));
    for (const QFileInfo &file : QDir(folder).entryInfoList({"*.json"}, QDir::Files)) {
        const Result<QJsonObject> sidecar = Sidecar::read(file.absoluteFilePath());
        if (!sidecar || sidecar->value("session").toString() != session.id)
            return refused(file.absoluteFilePath() + ": it is not of this session");
    }
    if (!QFileInfo(folder).isDir() || QFileInfo(folder).isSymLink())
        return refused(folder + ": it is no folder");
    return folder;
}

} // namespace

Result<void> renameSession(const RecordedSession &session, const QString &root, const QString &to) {
    const Result<QString> folder = folderOf(session, root);
    if (!folder)
        return folder.error();
    const QString target = QDir(root).absoluteFilePath(to);
    if (QFileInfo::exists(target))
        return diskError(target + ": it exists already; nothing was changed", target);
    if (!QDir().rename(*folder, target))
        return diskError(QString("%1: cannot be renamed to \"%2\"").arg(*folder, to), *folder);
    for (const QFileInfo &file : QDir(target).entryInfoList({"*.json"}, QDir::Files))
        if (Result<QJsonObject> sidecar = Sidecar::read(file.absoluteFilePath())) {
            sidecar->insert("name", to);
            if (const Result<void> written = Sidecar::write(file.absoluteFilePath(), *sidecar, true);
                !written)
                return written;
        }
    return {};
}

Result<void> removeSession(const RecordedSession &session, const QString &root) {
    const Result<QString> folder = folderOf(session, root);
    if (!folder)
        return folder.error();
    return QDir(*folder).removeRecursively()
               ? Result<void>()
               : diskError(*folder + ": not all of it could be removed", *folder);
}

} // namespace hermes::recorder
