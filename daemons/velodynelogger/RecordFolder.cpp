#include "daemons/velodynelogger/RecordFolder.h"

#include <QDateTime>
#include <QDir>
#include <QJsonObject>

namespace hermes {

Error diskError(const QString &message, const QString &path) {
    return Error(ErrorCode::InputOutput, message, QJsonObject{{"path", path}});
}

Result<QString> RecordFolder::newFile(const QString &name, const QString &suffix) const {
    if (name.isEmpty() || name.startsWith('.') || name.contains('/') || name.contains(QChar(0)))
        return Error(ErrorCode::InvalidParams,
                     QString("name: found \"%1\", expected the name of a file without a path").arg(name),
                     QJsonObject{{"name", "the name of a file without a path, not beginning with a dot"}});
    const QDir folder(path_);
    if (!folder.mkpath("."))
        return diskError(path_ + ": the folder for recordings cannot be made", path_);
    const QString path = folder.absoluteFilePath(name.endsWith('.' + suffix) ? name : name + '.' + suffix);
    if (QFileInfo::exists(path))
        return diskError(path + ": it exists already; recordings are not overwritten", path);
    return path;
}

QJsonArray RecordFolder::list() const {
    QJsonArray files;
    for (const QFileInfo &file : QDir(path_).entryInfoList({"*.pcap"}, QDir::Files, QDir::Time))
        files.append(QJsonObject{{"name", file.completeBaseName()},
                                 {"bytes", double(file.size())},
                                 {"modified", double(file.lastModified().toMSecsSinceEpoch()) * 1e-3}});
    return files;
}

} // namespace hermes
