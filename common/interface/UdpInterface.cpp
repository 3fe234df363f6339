#include "common/interface/UdpInterface.h"

#include <QNetworkDatagram>

#include <linux/sock_diag.h>
#include <sys/socket.h>

namespace hermes {

UdpInterface::UdpInterface(const InterfaceUrl &address, QObject *parent)
    : Interface(parent)
    , url(address) {
    const auto remote = InterfaceUrl::parse(url.option(QStringLiteral("peer")));
    if (remote && remote->port != 0) {
        peer = QHostAddress(remote->host);
        peerPort = remote->port;
        peerFixed = true;
    }
    connect(&socket, &QUdpSocket::readyRead, this, &UdpInterface::readAll);
}

QString UdpInterface::name() const {
    InterfaceUrl actual = url;
    if (isOpen())
        actual.port = socket.localPort();
    return actual.toString();
}

quint16 UdpInterface::localPort() const {
    return socket.localPort();
}

QMap<QString, quint64> UdpInterface::systemErrors() const {
    quint32 memory[SK_MEMINFO_VARS] = {};
    socklen_t size = sizeof memory;
    const auto descriptor = socket.socketDescriptor();
    if (descriptor < 0 || getsockopt(int(descriptor), SOL_SOCKET, SO_MEMINFO, memory, &size) != 0)
        return {};
    return {{QStringLiteral("datagrams"), memory[SK_MEMINFO_DROPS]}};
}

void UdpInterface::doOpen() {
    const QHostAddress host =
        url.host.isEmpty() ? QHostAddress(QHostAddress::AnyIPv4) : QHostAddress(url.host);
    const QString peerText = url.option(QStringLiteral("peer"));
    if (!peerText.isEmpty() && peer.isNull())
        return nowClosed(QStringLiteral("%1: peer \"%2\" is not IP:PORT").arg(url.toString(), peerText),
                         true);
    if (!socket.bind(host, url.port))
        return nowClosed(QStringLiteral("cannot bind %1: %2").arg(url.toString(), socket.errorString()),
                         true);
    const int room = url.option(QStringLiteral("receive_buffer")).toInt();
    if (room > 0)
        socket.setSocketOption(QAbstractSocket::ReceiveBufferSizeSocketOption, room);
    nowOpen();
}

void UdpInterface::doClose() {
    socket.close();
}

bool UdpInterface::doWrite(const QByteArray &bytes) {
    return peerPort != 0 && socket.writeDatagram(bytes, peer, peerPort) == bytes.size();
}

void UdpInterface::readAll() {
    while (isOpen() && socket.hasPendingDatagrams()) {
        const QNetworkDatagram datagram = socket.receiveDatagram();
        if (!datagram.isValid())
            continue; // an ICMP report about something sent earlier
        if (!peerFixed) {
            peer = datagram.senderAddress();
            peerPort = quint16(datagram.senderPort());
        }
        nowReceived(datagram.data());
    }
}

} // namespace hermes
