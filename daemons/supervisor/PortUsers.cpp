#include "daemons/supervisor/PortUsers.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QSet>
#include <cerrno>
#include <csignal>
#include <sys/stat.h>
#include <unistd.h>

namespace hermes::supervisor {
namespace {

const QString farEnd = "far end of "; // of a pseudo-terminal, before its number

QStringList processes() {
    return QDir("/proc").entryList({"[1-9]*"}, QDir::Dirs);
}

/// Which pseudo-terminal a descriptor is the far end of (pty(7)); empty: it is none.
QString farEndOf(const QString &pid, const QString &descriptor) {
    QFile info("/proc/" + pid + "/fdinfo/" + descriptor);
    if (info.open(QIODevice::ReadOnly))
        for (const QByteArray &line : info.readAll().split('\n'))
            if (line.startsWith("tty-index:"))
                return QString::fromLatin1(line.mid(line.indexOf(':') + 1).trimmed());
    return {};
}

/// Whether a descriptor leads to the file of that name here: containers have pseudo-terminals of their own.
bool isOurs(const QString &descriptor, const QString &file) {
    struct stat theirs {
    }, ours{};
    return ::stat(QFile::encodeName(descriptor).constData(), &theirs) == 0 &&
           ::stat(QFile::encodeName(file).constData(), &ours) == 0 && theirs.st_dev == ours.st_dev;
}

/// What the open descriptors of a process lead to; of other users' processes nothing.
QSet<QString> openFiles(const QString &pid) {
    const QDir folder("/proc/" + pid + "/fd");
    QSet<QString> files;
    for (const QString &descriptor : folder.entryList(QDir::Files | QDir::System)) {
        char target[4096];
        const auto size =
            ::readlink(QFile::encodeName(folder.filePath(descriptor)).constData(), target, sizeof target);
        const QString file = size > 0 ? QFile::decodeName(QByteArray(target, int(size))) : QString();
        if (file.startsWith("/dev/pts/") && !isOurs(folder.filePath(descriptor), file))
            continue;
        files.insert(file.endsWith("/ptmx") ? farEnd + farEndOf(pid, descriptor) : file);
    }
    return files;
}

QString nameOf(const QString &pid) {
    QFile line("/proc/" + pid + "/cmdline");
    const QByteArray program =
        line.open(QIODevice::ReadOnly) ? line.readAll().split('\0').first() : QByteArray();
    return QString("%1 (process %2)").arg(QFileInfo(QFile::decodeName(program)).fileName(), pid);
}

bool isFarEnd(const QString &device, const QSet<QString> &files) {
    const QString nearEnds = "/dev/pts/";
    return device.startsWith(nearEnds) && files.contains(farEnd + device.mid(nearEnds.size()));
}

bool isConsole(const QString &device) {
    QFile list("/sys/class/tty/console/active");
    return list.open(QIODevice::ReadOnly) &&
           QString::fromUtf8(list.readAll()).simplified().split(' ').contains(QFileInfo(device).fileName());
}

/// Programs lock serial lines by a file with their process id.
QString lockedBy(const QString &device) {
    QFile lock("/var/lock/LCK.." + QFileInfo(device).fileName());
    const pid_t pid = lock.open(QIODevice::ReadOnly) ? lock.readLine().trimmed().toInt() : 0;
    if (pid <= 0 || (::kill(pid, 0) != 0 && errno == ESRCH))
        return {};
    return nameOf(QString::number(pid));
}

/// The inodes of the sockets that receive at a port.
QSet<QString> socketsAt(quint16 port) {
    QSet<QString> sockets;
    constexpr int localAddress = 1, inode = 9;
    for (const char *const name : {"/proc/net/udp", "/proc/net/udp6"}) { // most of IPv6 receive IPv4, too
        QFile table(name);
        if (!table.open(QIODevice::ReadOnly))
            continue;
        for (const QByteArray &line : table.readAll().split('\n')) {
            const QList<QByteArray> fields = line.simplified().split(' ');
            if (fields.size() > inode && fields[localAddress].split(':').value(1).toInt(nullptr, 16) == port)
                sockets.insert(QString("socket:[%1]").arg(QString::fromLatin1(fields[inode])));
        }
    }
    return sockets;
}

} // namespace

QString PortUsers::ofDevice(const QString &device) {
    if (isConsole(device))
        return "the console of this computer";
    for (const QString &pid : processes()) {
        const QSet<QString> files = openFiles(pid);
        if (files.contains(device) && !isFarEnd(device, files))
            return nameOf(pid);
    }
    return lockedBy(device);
}

QString PortUsers::ofUdpPort(quint16 port) {
    const QSet<QString> sockets = socketsAt(port);
    if (sockets.isEmpty())
        return {};
    for (const QString &pid : processes())
        if (openFiles(pid).intersects(sockets))
            return nameOf(pid);
    return "a program of another user";
}

bool PortUsers::holdsFarEnd(qint64 pid, const QString &device) {
    return isFarEnd(device, openFiles(QString::number(pid)));
}

bool PortUsers::usesPorts(qint64 pid, const QList<quint16> &udpPorts) {
    const QSet<QString> files = openFiles(QString::number(pid));
    for (const quint16 port : udpPorts)
        if (files.intersects(socketsAt(port)))
            return true;
    return std::any_of(files.begin(), files.end(), [&files](const QString &file) {
        return (file.startsWith("/dev/tty") && file.size() > int(qstrlen("/dev/tty"))) ||
               (file.startsWith("/dev/pts/") && !isFarEnd(file, files));
    });
}

} // namespace hermes::supervisor
