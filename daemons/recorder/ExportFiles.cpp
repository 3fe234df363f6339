#include "daemons/recorder/ExportFiles.h"

#include "common/files/NamedFile.h"
#include "common/files/WriteAll.h"
#include "common/platform/PrivateFiles.h"
#include "common/recording/DiskError.h"

#include <QDir>
#include <QFileInfo>
#include <QRegularExpression>
#include <cstdio>
#include <unistd.h>

namespace hermes::recorder {

ExportFile::ExportFile(const QString &folder, const QString &name)
    : path_(folder + '/' + name)
    , draft_(folder + "/." + name + ".new") {
    QFile::remove(draft_); // of an export that was cut off, or a link
}

ExportFile::~ExportFile() {
    QFile::remove(draft_);
}

std::string ExportFile::draft() const {
    return QFile::encodeName(draft_).toStdString();
}

Result<QString> ExportFile::commit() const {
    if (std::rename(QFile::encodeName(draft_).constData(), QFile::encodeName(path_).constData()) != 0)
        return failure(qt_error_string());
    return path_;
}

void ExportFile::flush(bool toDisk) {
    QFile file;
    if (done_)
        done_ = openOwnFile(file, draft_, true);
    if (done_ && !(::lseek(file.handle(), 0, SEEK_END) >= 0 && writeAll(file.handle(), waiting_) &&
                   (!toDisk || syncToDisk(file.handle()))))
        done_ = failure(qt_error_string());
    waiting_.clear();
}

Error ExportFile::failure(const QString &why) const {
    return diskError(path_ + ": cannot be written: " + why, path_);
}

Result<void> ExportFiles::begin() const {
    for (const QString &folder : {QFileInfo(folder_).path(), folder_})
        if (QFileInfo(folder).isSymLink())
            return diskError(folder + ": it is a link; nothing is exported elsewhere", folder);
    if (!QDir().mkpath(folder_))
        return diskError(folder_ + ": is no folder, and cannot be made one", folder_);
    return {};
}

ExportFile &ExportFiles::open(QString name, const QString &extension) {
    name.replace(QRegularExpression("[^A-Za-z0-9._-]|^\\."), "-");
    QString unique = name.left(longestName) + extension;
    for (int number = 2; names_.contains(unique.toLower()); ++number)
        unique = QString("%1-%2%3").arg(name.left(longestName)).arg(number).arg(extension);
    names_.insert(unique.toLower());
    return files_.emplace_back(folder_, unique);
}

Result<void> ExportFiles::finish() {
    for (ExportFile &file : files_)
        if (Result<void> finished = file.finish(); !finished)
            return finished;
    return {};
}

Result<QStringList> ExportFiles::commit() const {
    QStringList paths;
    for (const ExportFile &file : files_) {
        const Result<QString> path = file.commit();
        if (!path)
            return path.error();
        paths.append(*path);
    }
    return paths;
}

} // namespace hermes::recorder
