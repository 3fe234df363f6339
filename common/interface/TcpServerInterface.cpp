#include "common/interface/TcpServerInterface.h"

#include "common/interface/TcpInterface.h"
#include "common/platform/Sockets.h"

namespace hermes {
namespace {

constexpr int acceptedAtOnce = 4;

} // namespace

TcpServerInterface::TcpServerInterface(const InterfaceUrl &address, QObject *parent)
    : TcpListener(address, acceptedAtOnce, 0, parent) {}

// A script may send its request and close its end.
bool TcpServerInterface::isHeard(qintptr descriptor) const {
    return sockets::hasUnread(descriptor);
}

void TcpServerInterface::take(qintptr descriptor) {
    auto *const socket = new QTcpSocket;
    socket->setSocketDescriptor(descriptor);
    auto *const peer = new TcpInterface(socket, this);
    peer->open();
    Q_EMIT accepted(peer);
}

} // namespace hermes
