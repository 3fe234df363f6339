#include "common/interface/LocalInterface.h"

#include "common/interface/LocalAddress.h"

namespace hermes {

LocalInterface::LocalInterface(const InterfaceUrl &address, QObject *parent)
    : TcpInterface(address, parent)
    , path_(address.path)
    , name_(address.toString()) {}

LocalInterface::LocalInterface(QTcpSocket *connected, const QString &name, uint user, QObject *theHost)
    : TcpInterface(connected, theHost)
    , name_(name)
    , user_(user) {}

// The kernel connects at once, or says why not.
void LocalInterface::doOpen() {
    if (isConnected())
        return nowOpen(); // a peer of a server
    const Result<LocalAddress> address = LocalAddress::of(path_);
    const int descriptor = address ? LocalAddress::makeSocket() : -1;
    if (descriptor < 0 || ::connect(descriptor, address->get(), address->size()) != 0) {
        const QString reason = address ? qt_error_string() : address.error().message;
        LocalAddress::closeSocket(descriptor);
        return nowClosed(QStringLiteral("%1: %2").arg(name_, reason), true);
    }
    takeConnected(descriptor);
}

} // namespace hermes
