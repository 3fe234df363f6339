#include "daemons/supervisor/PortUsers.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QSet>
#include <cerrno>
#include <csignal>
#include <unistd.h>

namespace hermes::supervisor {
namespace {

constexpr const char *terminalMaster = "/dev/ptmx"; // of pseudo-terminals; some have it in /dev/pts

QStringList processes() {
    return QDir("/proc").entryList({"[1-9]*"}, QDir::Dirs);
}

/// What the open descriptors of a process lead to; of other users' processes nothing.
QSet<QString> openFiles(const QString &pid) {
    const QDir folder("/proc/" + pid + "/fd");
    QSet<QString> files;
    for (const QString &descriptor : folder.entryList(QDir::Files | QDir::System)) {
        char target[4096];
        const auto size =
            ::readlink(QFile::encodeName(folder.filePath(descriptor)).constData(), target, sizeof target);
        if (size > 0)
            files.insert(QFile::decodeName(QByteArray(target, int(size))));
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
    return device.startsWith("/dev/pts/") &&
           (files.contains(terminalMaster) || files.contains("/dev/pts/ptmx"));
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
    QFile table("/proc/net/udp");
    QSet<QString> sockets;
    if (!table.open(QIODevice::ReadOnly))
        return sockets;
    constexpr int localAddress = 1, inode = 9;
    for (const QByteArray &line : table.readAll().split('\n')) {
        const QList<QByteArray> fields = line.simplified().split(' ');
        if (fields.size() > inode && fields[localAddress].split(':').value(1).toInt(nullptr, 16) == port)
            sockets.insert(QString("socket:[%1]").arg(QString::fromLatin1(fields[inode])));
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
