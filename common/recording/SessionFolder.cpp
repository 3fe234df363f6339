#include "common/recording/SessionFolder.h"

#include "common/files/Folder.h"
#include "common/recording/DiskError.h"
#include "common/recording/Sidecar.h"

#include <QDir>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace hermes {

namespace {

/// Whether the sidecars in the folder are all of this session.
Result<void> checkSession(const QString &folder, const QString &session) {
    for (const QFileInfo &file : QDir(folder).entryInfoList({"*.json"}, QDir::Files)) {
        const Result<QJsonObject> sidecar = Sidecar::read(file.absoluteFilePath());
        if (sidecar && sidecar->value("session").toString() != session)
            return diskError(QString("%1: a recording of another session is there (\"%2\", not \"%3\"); "
                                     "recordings are not mixed")
                                 .arg(folder, sidecar->value("session").toString(), session),
                             folder);
    }
    return {};
}

/// Whether the logger may join the folder, which exists.
Result<void> checkFolder(const QString &folder, const SessionName &session, const QString &logger,
                         bool goesOn) {
    if (!QFileInfo(folder).isDir())
        return diskError(folder + ": the folder of the recording cannot be made: a file has this name",
                         folder);
    if (QFileInfo(folder).isSymLink())
        return diskError(folder + ": it is a link; recordings are not written elsewhere", folder);
    const bool fresh = QDir(folder).entryList({logger + ".json", logger + "-*"}, QDir::Files).isEmpty();
    const bool empty = QDir(folder).isEmpty(QDir::AllEntries | QDir::Hidden | QDir::NoDotAndDotDot);
    const Result<QJsonObject> own =
        goesOn ? Sidecar::read(Sidecar::path(folder, logger)) : Result<QJsonObject>(QJsonObject());
    const bool isInterrupted = own && !session.session.isEmpty() &&
                               own->value("session") == session.session && own->value("ended").isString();
    if ((!fresh && !isInterrupted) || (session.session.isEmpty() && !empty))
        return diskError(folder + ": it exists already; recordings are not overwritten", folder);
    return checkSession(folder, session.session);
}

} // namespace

QString reservePath(const QString &folder, const QString &logger) {
    return folder + "/." + logger + ".reserve";
}

Result<QString> enterSessionFolder(const QString &root, const SessionName &session, const QString &logger,
                                   bool goesOn) {
    const QString folder = QDir(root).absoluteFilePath(session.name);
    QString why;
    for (int attempt = 0; attempt < 100; ++attempt) { // others may make and remove it at the same time
        if (!QDir(root).mkdir(session.name) && QFileInfo::exists(folder)) {
            const Result<void> joined = checkFolder(folder, session, logger, goesOn);
            if (!joined && QFileInfo::exists(folder))
                return joined.error();
        }
        // From here on the folder is not empty, so that no other logger can remove it.
        const QByteArray path = QFile::encodeName(reservePath(folder, logger));
        ::unlink(path.constData()); // of a recording that was cut off, or a link
        const int file = ::open(path.constData(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
        if (file >= 0) {
            ::close(file);
            return folder;
        }
        const bool gone = errno == ENOENT;
        why = qt_error_string();
        if (!gone)
            break;
    }
    QDir().rmdir(folder); // only when nothing is in it
    return diskError(folder + ": the folder of the recording cannot be made: " + why, folder);
}

Result<void> FolderLock::take(const QString &root, const QString &logger) {
    release();
    if (const Result<void> made = makeFolder(root); !made)
        return diskError(made.error().message, root);
    const QString path = QDir(root).absoluteFilePath('.' + logger + ".lock");
    const int file =
        ::open(QFile::encodeName(path).constData(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (file < 0)
        return diskError(path + ": cannot be made: " + qt_error_string(), path);
    if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
        const bool busy = errno == EWOULDBLOCK;
        const QString why = qt_error_string();
        ::close(file);
        return busy ? Error(ErrorCode::NotReady,
                            QString("another %1 records below %2; give this one a record.folder of its own")
                                .arg(logger, root))
                    : diskError(path + ": cannot be locked: " + why, path);
    }
    file_ = file;
    return {};
}

void FolderLock::release() {
    if (file_ >= 0)
        ::close(file_); // the file stays: removed, two could hold it
    file_ = -1;
}

} // namespace hermes
