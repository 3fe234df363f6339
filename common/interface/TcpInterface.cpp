#include "common/interface/TcpInterface.h"

#include "common/Time.h"
#include "common/interface/Farewell.h"
#include "common/interface/OwnSocket.h"
#include "common/interface/SocketOwner.h"
#include "common/platform/Sockets.h"

#include <QTimerEvent>
#include <utility>

namespace hermes {
namespace {

constexpr int receiveBufferBytes = 64 << 10; // what is not read stays with the sender
constexpr int handOverBytes = 128 << 10;     // to copy or encrypt so much takes a fraction of a millisecond
constexpr int joinedBytes = 16 << 10;        // many small messages would need much memory beside their bytes
constexpr int readAtOnceBytes = 4 << 10;     // some dozens of requests; then others get their turn

} // namespace

TcpInterface::TcpInterface(const InterfaceUrl &address, QObject *parent)
    : TcpInterface(address, new QTcpSocket, parent) {
    // Queued: it may change its socket for another one.
    connect(socket_, &QTcpSocket::connected, this, &TcpInterface::begin, Qt::QueuedConnection);
}

TcpInterface::TcpInterface(const InterfaceUrl &address, QTcpSocket *socket, QObject *parent)
    : Interface(parent)
    , url_(address)
    , socket_(socket) {
    socket_->setParent(this);
    prepare();
}

TcpInterface::TcpInterface(QTcpSocket *connected, QObject *theHost)
    : Interface(theHost)
    , socket_(connected)
    , host_(theHost) {
    socket_->setParent(this);
    url_.scheme = QStringLiteral("tcp");
    url_.host = socket_->peerAddress().toString();
    url_.port = socket_->peerPort();
    socket_->setSocketOption(QAbstractSocket::LowDelayOption, 1);
    watchPeer();
    prepare();
}

void TcpInterface::begin() {
    if (state() != State::Opening || !isConnected())
        return;
    // A daemon that has begun to listen since the first try.
    if (const int own = connectToOwn(); own >= 0) {
        socket_->abort();
        return takeConnected(own);
    }
    socket_->setSocketOption(QAbstractSocket::LowDelayOption, 1);
    watchPeer();
    readLater(); // what has come already
    nowOpen();
}

/// One that vanished is found within 5 s, whether it is only read or something waits for it.
void TcpInterface::watchPeer() {
    constexpr int period_ms = 1000;
    sockets::askPeer(socket_->socketDescriptor());
    watch_.start(period_ms, this);
}

void TcpInterface::timerEvent(QTimerEvent *event) {
    if (event->timerId() != watch_.timerId())
        return Interface::timerEvent(event);
    if (!isOpen())
        return watch_.stop();
    if (!sockets::isPeerLost(socket_->socketDescriptor()))
        return;
    watch_.stop();
    socket_->abort();
    forgetWaiting();
    nowClosed(QStringLiteral("%1: the peer does not answer any more").arg(name()), true);
}

int TcpInterface::connectToOwn() const {
    return url_.option(QStringLiteral("own")) == QStringLiteral("1") ? connectToOwnSocket(url_) : -1;
}

void TcpInterface::prepare() {
    socket_->setReadBufferSize(receiveBufferBytes);
    connect(socket_, &QTcpSocket::readyRead, this, &TcpInterface::readSome);
    connect(socket_, &QTcpSocket::bytesWritten, this, &TcpInterface::noteWritten);
    connect(this, &Interface::closed, this, &TcpInterface::forgetWaiting);
    connect(socket_, &QTcpSocket::errorOccurred, this, [this](QAbstractSocket::SocketError error) {
        const bool peerClosed = error == QAbstractSocket::RemoteHostClosedError;
        const QPointer<TcpInterface> alive(this);
        noteUnread();
        if (const QByteArray rest = socket_->readAll(); !rest.isEmpty())
            nowReceived(rest); // what it said before it closed
        if (!alive)
            return;
        const QString reason = peerClosed ? QStringLiteral("closed by the peer") : failure();
        socket_->abort();
        forgetWaiting();
        nowClosed(QStringLiteral("%1: %2").arg(name(), reason), !peerClosed);
    });
}

bool TcpInterface::setReceiving(bool on) {
    if (on && !receiving_)
        readLater();
    receiving_ = on;
    return true;
}

bool TcpInterface::hasUnread() const {
    return socket_->bytesAvailable() > 0 || (isOpen() && sockets::hasUnread(socket_->socketDescriptor()));
}

void TcpInterface::noteUnread() {
    if (!std::exchange(hasLeft_, true))
        unreadSince_ = bootNow();
}

void TcpInterface::noteRead() {
    hasLeft_ = hasUnread();
}

void TcpInterface::readSome() {
    noteUnread();
    if (readsOn_ || !receiving_ || !isOpen())
        return;
    const QByteArray bytes = socket_->read(readAtOnceBytes);
    if (socket_->bytesAvailable() > 0)
        readLater();
    noteRead();
    if (!bytes.isEmpty())
        nowReceived(bytes);
}

void TcpInterface::readLater() {
    if (std::exchange(readsOn_, true))
        return;
    const auto readOn = [this] {
        readsOn_ = false;
        readSome();
    };
    QMetaObject::invokeMethod(this, readOn, Qt::QueuedConnection);
}

QString TcpInterface::name() const {
    return url_.toString();
}

void TcpInterface::doOpen() {
    receiving_ = true;
    hasLeft_ = false;
    if (isConnected())
        return nowOpen(); // a peer of a server
    if (const int own = connectToOwn(); own >= 0)
        takeConnected(own);
    else
        socket_->connectToHost(url_.host, url_.port);
}

Peer TcpInterface::peer() const {
    const QHostAddress theirs = socket_->peerAddress(), ours = socket_->localAddress();
    const auto user = ownerOfSocket({theirs, socket_->peerPort()}, {ours, socket_->localPort()});
    // A program of this computer may come from any address of it.
    if (user || theirs.isLoopback() || ours.isLoopback() || theirs == ours)
        return {Peer::Place::Computer, user};
    return {};
}

void TcpInterface::takeConnected(qintptr descriptor) {
    receiving_ = true;
    socket_->setSocketDescriptor(descriptor);
    nowOpen();
}

void TcpInterface::doClose() {
    flush();
    if (host_ && socket_->socketDescriptor() >= 0)
        sayFarewell(int(socket_->socketDescriptor()), host_);
    socket_->abort();
}

bool TcpInterface::doWrite(const QByteArray &bytes) {
    if (waiting_.empty() && bytes.size() <= handOverBytes && bytesInSocket() < handOverBytes)
        return socket_->write(bytes) == bytes.size();
    if (!waiting_.empty() && waiting_.back().size() + bytes.size() <= joinedBytes)
        waiting_.back() += bytes;
    else
        waiting_.push_back(bytes);
    waitingBytes_ += bytes.size();
    handOver();
    return true;
}

void TcpInterface::handOver() {
    while (!waiting_.empty() && bytesInSocket() < handOverBytes) {
        const QByteArray part = waiting_.front().mid(begunBytes_, handOverBytes);
        begunBytes_ += part.size();
        waitingBytes_ -= part.size();
        if (begunBytes_ == waiting_.front().size()) {
            waiting_.pop_front();
            begunBytes_ = 0;
        }
        socket_->write(part);
    }
}

void TcpInterface::forgetWaiting() {
    waiting_.clear();
    waitingBytes_ = begunBytes_ = 0;
}

void TcpInterface::noteWritten() {
    handOver();
    Q_EMIT drained();
}

void TcpInterface::flush() {
    do {
        handOver();
        socket_->flush();
    } while (!waiting_.empty() && bytesInSocket() < handOverBytes);
}

} // namespace hermes
