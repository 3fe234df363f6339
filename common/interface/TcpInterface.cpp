#include "common/interface/TcpInterface.h"

#include "common/interface/Farewell.h"

#include <sys/ioctl.h>
#include <utility>

namespace hermes {
namespace {

constexpr int receiveBufferBytes = 64 << 10; // what is not read stays with the sender
constexpr int readAtOnceBytes = 4 << 10;     // some dozens of requests; then others get their turn

} // namespace

TcpInterface::TcpInterface(const InterfaceUrl &address, QObject *parent)
    : Interface(parent)
    , url(address)
    , socket(new QTcpSocket(this)) {
    prepare();
    connect(socket, &QTcpSocket::connected, this, [this] {
        socket->setSocketOption(QAbstractSocket::LowDelayOption, 1);
        socket->setSocketOption(QAbstractSocket::KeepAliveOption, 1);
        nowOpen();
    });
}

TcpInterface::TcpInterface(QTcpSocket *connected, QObject *theHost)
    : Interface(theHost)
    , socket(connected)
    , host(theHost) {
    socket->setParent(this);
    url.scheme = QStringLiteral("tcp");
    url.host = socket->peerAddress().toString();
    url.port = socket->peerPort();
    socket->setSocketOption(QAbstractSocket::LowDelayOption, 1);
    socket->setSocketOption(QAbstractSocket::KeepAliveOption, 1);
    prepare();
}

void TcpInterface::prepare() {
    socket->setReadBufferSize(receiveBufferBytes);
    connect(socket, &QTcpSocket::readyRead, this, &TcpInterface::readSome);
    connect(socket, &QTcpSocket::bytesWritten, this, &Interface::drained);
    connect(socket, &QTcpSocket::errorOccurred, this, [this](QAbstractSocket::SocketError error) {
        const bool peerClosed = error == QAbstractSocket::RemoteHostClosedError;
        const QPointer<TcpInterface> alive(this);
        if (const QByteArray rest = socket->readAll(); !rest.isEmpty())
            nowReceived(rest); // what it said before it closed
        if (!alive)
            return;
        const QString reason = peerClosed ? QStringLiteral("closed by the peer") : socket->errorString();
        socket->abort();
        nowClosed(QStringLiteral("%1: %2").arg(name(), reason), !peerClosed);
    });
}

bool TcpInterface::setReceiving(bool on) {
    if (on && !receiving)
        readLater();
    receiving = on;
    return true;
}

bool TcpInterface::hasUnread() const {
    int unread = 0;
    return socket->bytesAvailable() > 0 ||
           (isOpen() && ::ioctl(int(socket->socketDescriptor()), FIONREAD, &unread) == 0 && unread > 0);
}

void TcpInterface::readSome() {
    if (readsOn || !receiving || !isOpen())
        return;
    const QByteArray bytes = socket->read(readAtOnceBytes);
    if (socket->bytesAvailable() > 0)
        readLater();
    if (!bytes.isEmpty())
        nowReceived(bytes);
}

void TcpInterface::readLater() {
    if (std::exchange(readsOn, true))
        return;
    const auto readOn = [this] {
        readsOn = false;
        readSome();
    };
    QMetaObject::invokeMethod(this, readOn, Qt::QueuedConnection);
}

QString TcpInterface::name() const {
    return url.toString();
}

qint64 TcpInterface::bytesToWrite() const {
    return socket->bytesToWrite();
}

void TcpInterface::doOpen() {
    receiving = true;
    if (socket->state() == QAbstractSocket::ConnectedState)
        nowOpen(); // a peer of a server
    else
        socket->connectToHost(url.host, url.port);
}

void TcpInterface::doClose() {
    socket->flush();
    if (host && socket->socketDescriptor() >= 0)
        Farewell::say(int(socket->socketDescriptor()), host);
    socket->abort();
}

bool TcpInterface::doWrite(const QByteArray &bytes) {
    return socket->write(bytes) == bytes.size();
}

} // namespace hermes
