#include "common/interface/LocalServerInterface.h"

#include "common/interface/LocalAddress.h"
#include "common/interface/LocalInterface.h"

#include <QJsonObject>
#include <cerrno>
#include <sys/stat.h>

namespace hermes {
namespace {

constexpr int peersAtOnce = 4; // then others have their turn
constexpr uint ownerOnly = 0600;
constexpr int sendBufferBytes = 1 << 20;

struct stat statusOf(const char *path) {
    struct stat status {};
    if (::lstat(path, &status) != 0)
        status = {};
    return status;
}

/// Whether a program listens there.
bool isAlive(const LocalAddress &address) {
    const int probe = LocalAddress::makeSocket();
    const bool connected = ::connect(probe, address.get(), address.size()) == 0 || errno == EAGAIN;
    LocalAddress::closeSocket(probe);
    return connected;
}

} // namespace

LocalServerInterface::LocalServerInterface(const InterfaceUrl &address, QObject *parent)
    : Listener(parent)
    , url_(address) {}

LocalServerInterface::~LocalServerInterface() {
    LocalServerInterface::close();
}

Error LocalServerInterface::refuse(const QString &why) const {
    return {ErrorCode::InputOutput, QString("cannot listen on %1: %2").arg(url_.toString(), why),
            QJsonObject{{"path", url_.path}}};
}

Result<void> LocalServerInterface::makeFree(const LocalAddress &address) const {
    const struct stat before = statusOf(address.path());
    if (before.st_ino == 0)
        return {};
    if (!S_ISSOCK(before.st_mode))
        return refuse("a file of this name exists, and it is not a socket");
    if (isAlive(address))
        return refuse("another program listens there");
    ::unlink(address.path());
    return {};
}

Result<void> LocalServerInterface::listen() {
    const Result<LocalAddress> address = LocalAddress::of(url_.path);
    if (!address)
        return refuse(address.error().message);
    bool isMode = true;
    const QString modeText = url_.option("mode");
    const uint mode = modeText.isEmpty() ? ownerOnly : modeText.toUInt(&isMode, 8);
    if (!isMode || mode > 0777)
        return refuse(QString("mode \"%1\", expected permissions as 0660").arg(modeText));
    if (const auto free = address->isFile() ? makeFree(*address) : Result<void>(); !free)
        return free;
    descriptor_ = LocalAddress::makeSocket();
    // Nobody connects before it listens, and then the permissions are those that were asked for.
    if (descriptor_ < 0 || ::bind(descriptor_, address->get(), address->size()) != 0 ||
        (address->isFile() && ::chmod(address->path(), mode) != 0) || ::listen(descriptor_, SOMAXCONN) != 0) {
        const Error error = refuse(qt_error_string());
        LocalAddress::closeSocket(std::exchange(descriptor_, -1));
        return error;
    }
    file_ = address->isFile() ? statusOf(address->path()).st_ino : 0;
    arrivals_ = std::make_unique<QSocketNotifier>(descriptor_, QSocketNotifier::Read);
    connect(arrivals_.get(), &QSocketNotifier::activated, this, &LocalServerInterface::takePeers);
    return {};
}

void LocalServerInterface::close() {
    if (descriptor_ < 0)
        return;
    arrivals_.reset();
    LocalAddress::closeSocket(std::exchange(descriptor_, -1));
    const QByteArray path = QFile::encodeName(url_.path);
    if (file_ != 0 && statusOf(path.constData()).st_ino == file_) // else another program has the name by now
        ::unlink(path.constData());
}

void LocalServerInterface::takePeers() {
    for (int i = 0; i < peersAtOnce; ++i) {
        const int descriptor = ::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (descriptor < 0)
            return;
        take(descriptor);
    }
}

void LocalServerInterface::take(int descriptor) {
    ucred peer{};
    socklen_t size = sizeof peer;
    if (isScarce(descriptor) || ::getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0)
        return LocalAddress::closeSocket(descriptor);
    // As far as the system allows: what does not fit waits for a round of the event loop, as a stop's reply
    // does.
    const int much = sendBufferBytes;
    ::setsockopt(descriptor, SOL_SOCKET, SO_SNDBUF, &much, sizeof much);
    auto *socket = new QTcpSocket;
    socket->setSocketDescriptor(descriptor);
    auto *carrier = new LocalInterface(
        socket, QString("%1 (process %2 of user %3)").arg(address()).arg(peer.pid).arg(peer.uid), peer.uid,
        this);
    carrier->open();
    Q_EMIT accepted(carrier);
}

} // namespace hermes
