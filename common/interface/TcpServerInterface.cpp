#include "common/interface/TcpServerInterface.h"

#include "common/interface/TcpInterface.h"

#include <sys/socket.h>

namespace hermes {
namespace {

constexpr int acceptedAtOnce = 4;

} // namespace

TcpServerInterface::TcpServerInterface(const InterfaceUrl &address, QObject *parent)
    : Listener(parent)
    , url_(address) {
    // Queued, and no more are accepted meanwhile: else peers who come faster than they are taken would keep
    // the event loop here.
    server_.setMaxPendingConnections(acceptedAtOnce);
    connect(&server_, &QTcpServer::newConnection, this, &TcpServerInterface::takePeers, Qt::QueuedConnection);
}

Result<void> TcpServerInterface::listen() {
    QHostAddress host(url_.host == QStringLiteral("localhost") ? QStringLiteral("127.0.0.1") : url_.host);
    if (host.isNull()) {
        return Error(ErrorCode::InputOutput,
                     QStringLiteral("cannot listen on %1: \"%2\" is not an IP address")
                         .arg(url_.toString(), url_.host));
    }
    if (server_.listen(host, url_.port)) {
        ::listen(int(server_.socketDescriptor()), SOMAXCONN); // Qt lets only 50 wait
        return {};
    }
    QString reason = server_.errorString();
    if (server_.serverError() == QAbstractSocket::AddressInUseError) {
        reason = QStringLiteral("port %1 of %2 is already in use; end the program that uses it or listen "
                                "elsewhere (--listen URL)")
                     .arg(url_.port)
                     .arg(url_.host);
    }
    return Error(ErrorCode::InputOutput,
                 QStringLiteral("cannot listen on %1: %2").arg(url_.toString(), reason));
}

void TcpServerInterface::close() {
    server_.close();
}

QString TcpServerInterface::address() const {
    InterfaceUrl actual = url_;
    if (server_.isListening())
        actual.port = server_.serverPort();
    return actual.toString();
}

void TcpServerInterface::takePeers() {
    while (QTcpSocket *socket = server_.nextPendingConnection())
        take(socket);
}

void TcpServerInterface::take(QTcpSocket *socket) {
    if (isScarce(socket->socketDescriptor()))
        return delete socket;
    auto *peer = new TcpInterface(socket, this);
    peer->open();
    Q_EMIT accepted(peer);
}

} // namespace hermes
