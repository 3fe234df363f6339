#include "common/interface/PtyInterface.h"

#include "common/interface/AnySpeed.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace hermes {
namespace {

QString systemError() {
    return QString::fromLocal8Bit(std::strerror(errno));
}

} // namespace

PtyInterface::PtyInterface(const InterfaceUrl &address, QObject *parent)
    : Interface(parent)
    , url_(address) {}

PtyInterface::~PtyInterface() {
    doClose();
}

void PtyInterface::doOpen() {
    QString wrong = makePair();
    if (wrong.isEmpty())
        wrong = makeLink();
    if (!wrong.isEmpty()) {
        doClose();
        return nowClosed(QStringLiteral("cannot open %1: %2").arg(name(), wrong), true);
    }
    readable_ = std::make_unique<QSocketNotifier>(farFd_, QSocketNotifier::Read);
    connect(readable_.get(), &QSocketNotifier::activated, this, &PtyInterface::readSome);
    nowOpen();
}

QString PtyInterface::makePair() {
    char path[256];
    termios raw{};
    cfmakeraw(&raw);
    cfsetspeed(&raw, B115200);
    if (openpty(&farFd_, &nearFd_, path, &raw, nullptr) != 0)
        return QStringLiteral("no pseudo-terminal: ") + systemError();
    for (const int fd : {farFd_, nearFd_})
        fcntl(fd, F_SETFD, FD_CLOEXEC);
    fcntl(farFd_, F_SETFL, O_NONBLOCK);
    nearEnd_ = QString::fromLocal8Bit(path);
    return {};
}

QString PtyInterface::makeLink() {
    if (url_.path.isEmpty())
        return {};
    const QFileInfo link(url_.path);
    if (link.exists() && !link.isSymLink())
        return QStringLiteral("a file of this name exists, and it is not a link");
    if (!QDir().mkpath(link.absolutePath()))
        return QStringLiteral("the folder %1 cannot be made").arg(link.absolutePath());
    QFile::remove(url_.path); // of a program that ended without removing it
    if (symlink(QFile::encodeName(nearEnd_).constData(), QFile::encodeName(url_.path).constData()) != 0)
        return QStringLiteral("the link cannot be made: ") + systemError();
    return {};
}

void PtyInterface::doClose() {
    readable_.reset();
    if (!nearEnd_.isEmpty() && QFile::symLinkTarget(url_.path) == nearEnd_)
        QFile::remove(url_.path);
    nearEnd_.clear();
    for (int *fd : {&farFd_, &nearFd_}) {
        if (*fd >= 0)
            ::close(*fd);
        *fd = -1;
    }
}

qint64 PtyInterface::unread() const {
    int size = 0;
    return nearFd_ >= 0 && ioctl(nearFd_, FIONREAD, &size) == 0 ? size : 0;
}

qint64 PtyInterface::discardUnread() {
    const qint64 size = unread();
    if (size > 0)
        tcflush(nearFd_, TCIFLUSH);
    return size;
}

int PtyInterface::baud() const {
    return nearFd_ >= 0 ? speedOf(nearFd_) : 0;
}

void PtyInterface::setBaud(int baud) {
    if (baud > 0 && nearFd_ >= 0)
        setSpeed(nearFd_, baud);
}

bool PtyInterface::doWrite(const QByteArray &bytes) {
    dropClaim();
    // Nobody reads: bytes are lost, as on a line that nobody listens to.
    const ssize_t written = ::write(farFd_, bytes.constData(), std::size_t(bytes.size()));
    return written == bytes.size();
}

// A program that opens a serial port claims it alone; one that is killed leaves the claim, which would end
// only with the last opener: nearFd.
void PtyInterface::dropClaim() {
    ioctl(nearFd_, TIOCNXCL);
}

void PtyInterface::readSome() {
    dropClaim();
    char buffer[4096];
    const ssize_t size = ::read(farFd_, buffer, sizeof buffer);
    if (size > 0)
        nowReceived(QByteArray(buffer, int(size)));
}

} // namespace hermes
