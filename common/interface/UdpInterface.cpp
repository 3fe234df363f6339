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
    const auto remote = InterfaceUrl::parse(url_.option("peer"));
    if (remote && remote->port != 0) {
        peer_ = QHostAddress(remote->host);
        peerPort_ = remote->port;
        peerFixed_ = true;
    }
    const QString from = url_.option("from");
    keepsToFirst_ = from == "first";
    if (!keepsToFirst_) {
        from_ = QHostAddress(from.section(QLatin1Char(':'), 0, 0));
        fromPort_ = quint16(from.section(QLatin1Char(':'), 1).toUInt());
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
    return {{"datagrams", memory[SK_MEMINFO_DROPS]}};
}

void UdpInterface::doOpen() {
    const QHostAddress host =
        url_.host.isEmpty() ? QHostAddress(QHostAddress::AnyIPv4) : QHostAddress(url_.host);
    const QString peerText = url_.option("peer");
    if (!peerText.isEmpty() && peer_.isNull())
        return nowClosed(QString("%1: peer \"%2\" is not IP:PORT").arg(url_.toString(), peerText), true);
    const QString from = url_.option("from");
    if (!from.isEmpty() && !keepsToFirst_ && from_.isNull())
        return nowClosed(QString("%1: from \"%2\" is not IP, IP:PORT or first").arg(url_.toString(), from),
                         true);
    if (!socket_.bind(host, url_.port))
        return nowClosed(QString("cannot bind %1: %2").arg(url_.toString(), socket_.errorString()), true);
    const int room = url_.option("receive_buffer").toInt();
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
        if (!isRead(datagram.senderAddress(), quint16(datagram.senderPort())))
            continue;
        if (!peerFixed_) {
            peer_ = datagram.senderAddress();
            peerPort_ = quint16(datagram.senderPort());
        }
        nowReceived(datagram.data());
    }
}

bool UdpInterface::isRead(const QHostAddress &address, quint16 port) {
    constexpr qint64 longestSilence_ms = 3000;
    constexpr int maxNames = 5, maxPorts = 4, enoughReturns = 3;
    if (keepsToFirst_ && (from_.isNull() || sinceFrom_.elapsed() > longestSilence_ms)) {
        from_ = address;
        fromPort_ = port;
        leftPorts_.clear();
        returns_ = 0;
    }
    // Some programs send each datagram from another port, which may come again by chance. Ports that come
    // back again and again show that there are two senders.
    if (keepsToFirst_ && from_.isEqual(address) && port != fromPort_ && returns_ < enoughReturns) {
        returns_ = leftPorts_.contains(port) ? returns_ + 1 : 0;
        leftPorts_.append(fromPort_);
        if (leftPorts_.size() > maxPorts)
            leftPorts_.removeFirst();
        fromPort_ = port;
    }
    if (from_.isNull() || (from_.isEqual(address) && (fromPort_ == 0 || fromPort_ == port))) {
        sinceFrom_.start();
        return true;
    }
    ++strangers_.datagrams;
    const QString name = QString("%1:%2").arg(address.toString()).arg(port);
    if (!strangers_.names.contains(name) && strangers_.names.size() < maxNames)
        strangers_.names.append(name);
    return false;
}

} // namespace hermes
