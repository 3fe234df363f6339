#include "daemons/motorcontrol/LatchFile.h"

#include "common/files/Folder.h"
#include "common/files/NamedFile.h"
#include "common/interface/InterfaceUrl.h"
#include "common/recording/FileSync.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QHostAddress>
#include <QRegularExpression>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <sys/file.h>

namespace hermes::motorcontrol {
namespace {

constexpr int longestName = 200; // of a file
constexpr int fileBytes = 8192;
constexpr int longestReason = 1000;

/// How a daemon is known that listens there.
QString markOf(const QString &address) {
    const auto url = InterfaceUrl::parse(address);
    if (!url || (url->port == 0 && url->path.isEmpty()))
        return {};
    return url->port != 0 ? QString("port %1").arg(url->port) : url->path;
}

/// How a robot is known that is driven through this line; empty: it is simulated here, and the next one has
/// the same.
QString markOfRobot(const QString &line) {
    const auto url = InterfaceUrl::parse(line);
    const bool isSimulated = !url || QFileInfo(url->path).canonicalFilePath().startsWith("/dev/pts/") ||
                             url->host == "localhost" || QHostAddress(url->host).isLoopback();
    return isSimulated ? QString() : url->toString();
}

Error failed(const QString &path, const QString &why) {
    return {ErrorCode::InputOutput,
            QString("an emergency stop does not outlive this program: %1: %2").arg(path, why)};
}

/// The reason, and the marks after it; empty: it cannot be read, or its motor control is running.
QStringList linesOf(const QString &path) {
    QFile file;
    return openOwnFile(file, path) && ::flock(file.handle(), LOCK_SH | LOCK_NB) == 0
               ? QString::fromUtf8(file.read(fileBytes)).split('\n', Qt::SkipEmptyParts)
               : QStringList();
}

} // namespace

LatchFile::~LatchFile() {
    if (file_.isOpen() && !isLatched_)
        QFile::remove(draft());
}

void LatchFile::setPlace(const QString &settingsFile, const QStringList &listen, const QStringList &lines) {
    path_.clear();
    marks_.clear();
    for (const QString &address : listen)
        marks_.append(markOf(address));
    marks_.removeAll({});
    if (marks_.isEmpty())
        return;
    if (!settingsFile.isEmpty())
        marks_.append(QFileInfo(settingsFile).absoluteFilePath());
    for (const QString &line : lines)
        marks_.append(markOfRobot(line));
    marks_.removeAll({});
    marks_.removeDuplicates();
    QString name = (listen + lines).join('+');
    name.replace(QRegularExpression("[^A-Za-z0-9.+-]+"), "_");
    path_ = stateFolder() + "/estop/" + name.left(longestName);
}

Result<void> LatchFile::reserve() {
    if (path_.isEmpty())
        return {};
    const QString folder = QFileInfo(path_).path();
    if (const auto made = makeFolder(folder); !made)
        return failed(folder, made.error().message);
    if (QFileInfo(draft()).isSymLink())
        QFile::remove(draft());
    if (const auto opened = openOwnFile(file_, draft(), true); !opened)
        return failed(draft(), opened.error().message);
    if (::flock(file_.handle(), LOCK_EX | LOCK_NB) != 0) { // as long as this program lives
        file_.close();
        return failed(draft(), "another motor control with these settings is running");
    }
    if (file_.write(QByteArray(fileBytes, '\n')) != fileBytes || !file_.flush())
        return failed(draft(), file_.errorString());
    disk_.start([path = draft()] { syncFile(path); });
    return {};
}

QStringList LatchFile::found() const {
    QStringList paths;
    if (path_.isEmpty())
        return paths;
    if (QFile::exists(path_) || QFileInfo(path_).isSymLink())
        paths.append(path_);
    const QDir folder(QFileInfo(path_).path());
    for (const QString &name :
         folder.entryList(QDir::AllEntries | QDir::System | QDir::Hidden | QDir::NoDotAndDotDot)) {
        const QString path = folder.filePath(name);
        const QStringList lines = name.endsWith(".new") ? QStringList() : linesOf(path);
        if (path != path_ && std::any_of(marks_.begin(), marks_.end(),
                                         [&](const QString &mark) { return lines.indexOf(mark, 1) > 0; }))
            paths.append(path);
    }
    return paths;
}

std::optional<QString> LatchFile::read() {
    const QStringList paths = found();
    if (paths.isEmpty())
        return std::nullopt;
    taken_ = paths;
    for (const QString &path : paths)
        takenMarks_ += linesOf(path).mid(1);
    takenMarks_.removeDuplicates();
    const QStringList lines = linesOf(paths.first());
    return lines.isEmpty() ? "an emergency stop of which nothing is known: " + paths.first()
                           : lines.first().simplified();
}

Result<void> LatchFile::write(const std::optional<QString> &reason) {
    if (path_.isEmpty())
        return {};
    const QString folder = QFileInfo(path_).path();
    if (!reason) {
        for (const QString &path : taken_ + QStringList(path_))
            if (!QFile::remove(path) && QFile::exists(path))
                return Error(ErrorCode::InputOutput,
                             QString("%1 cannot be removed: %2; the next start latches the "
                                     "emergency stop again")
                                 .arg(path, std::strerror(errno)));
        taken_.clear();
        takenMarks_.clear();
        isLatched_ = false;
        file_.close();
        disk_.start([folder] { syncFolder(folder); });
        return reserve();
    }
    const QByteArray text = (QStringList(reason->left(longestReason).simplified()) + marks_ + takenMarks_)
                                .join('\n')
                                .toUtf8()
                                .left(fileBytes - 1);
    if (!file_.isOpen())
        if (const auto made = reserve(); !made)
            return made;
    if (!file_.seek(0) || file_.write(text.leftJustified(fileBytes, '\n')) != fileBytes || !file_.flush())
        return failed(path_, file_.errorString());
    if (!isLatched_ && std::rename(QFile::encodeName(draft()), QFile::encodeName(path_)) != 0)
        return failed(path_, std::strerror(errno));
    isLatched_ = true;
    disk_.start([path = path_, folder] {
        syncFile(path);
        syncFolder(folder);
    });
    return {};
}

} // namespace hermes::motorcontrol
