#include "common/interface/UdpInterface.h"

#include "common/Time.h"

#include <QNetworkDatagram>
#include <linux/sock_diag.h>
#include <sys/socket.h>

namespace hermes {
namespace {

constexpr double longest_s = 0.001; // to read at once

} // namespace

UdpInterface::UdpInterface(const InterfaceUrl &address, QObject *parent)
    : Interface(parent)
    , url_(address) {
    const auto remote = InterfaceUrl::parse(url_.option(QStringLiteral("peer")));
    if (remote && remote->port != 0) {
        peer_ = QHostAddress(remote->host);
        peerPort_ = remote->port;
        peerFixed_ = true;
    }
    connect(&socket_, &QUdpSocket::readyRead, this, &UdpInterface::readAll);
}

QString UdpInterface::name() const {
    InterfaceUrl actual = url_;
    if (isOpen())
        actual.port = socket_.localPort();
    return actual.toString();
}

quint16 UdpInterface::localPort() const {
    return socket_.localPort();
}

QMap<QString, quint64> UdpInterface::systemErrors() const {
    quint32 memory[SK_MEMINFO_VARS] = {};
    socklen_t size = sizeof memory;
    const auto descriptor = socket_.socketDescriptor();
    if (descriptor < 0 || getsockopt(int(descriptor), SOL_SOCKET, SO_MEMINFO, memory, &size) != 0)
        return {};
    return {{QStringLiteral("datagrams"), memory[SK_MEMINFO_DROPS]}};
}

void UdpInterface::doOpen() {
    const QHostAddress host =
        url_.host.isEmpty() ? QHostAddress(QHostAddress::AnyIPv4) : QHostAddress(url_.host);
    const QString peerText = url_.option(QStringLiteral("peer"));
    if (!peerText.isEmpty() && peer_.isNull())
        return nowClosed(QStringLiteral("%1: peer \"%2\" is not IP:PORT").arg(url_.toString(), peerText),
                         true);
    if (!socket_.bind(host, url_.port))
        return nowClosed(QStringLiteral("cannot bind %1: %2").arg(url_.toString(), socket_.errorString()),
                         true);
    const int room = url_.option(QStringLiteral("receive_buffer")).toInt();
    if (room > 0)
        socket_.setSocketOption(QAbstractSocket::ReceiveBufferSizeSocketOption, room);
    nowOpen();
}

void UdpInterface::doClose() {
    socket_.close();
}

bool UdpInterface::doWrite(const QByteArray &bytes) {
    return peerPort_ != 0 && socket_.writeDatagram(bytes, peer_, peerPort_) == bytes.size();
}

void UdpInterface::readAll() {
    // Who sends without end does not keep the event loop here: it tells again that there are more.
    const double until = monotonicNow() + longest_s;
    bool hasTime = true;
    for (; hasTime && isOpen() && socket_.hasPendingDatagrams(); hasTime = monotonicNow() < until) {
        const QNetworkDatagram datagram = socket_.receiveDatagram();
        if (!datagram.isValid())
            continue; // an ICMP report about something sent earlier
        if (!peerFixed_) {
            peer_ = datagram.senderAddress();
            peerPort_ = quint16(datagram.senderPort());
        }
        nowReceived(datagram.data());
    }
}

} // namespace hermes
