#include "common/interface/InterfaceKinds.h"

#include "common/interface/Listener.h"
#include "common/interface/LocalInterface.h"
#include "common/interface/LocalServerInterface.h"
#include "common/interface/PtyInterface.h"
#include "common/interface/SerialInterface.h"
#include "common/interface/TcpInterface.h"
#include "common/interface/TcpServerInterface.h"
#include "common/interface/TlsInterface.h"
#include "common/interface/TlsServerInterface.h"
#include "common/interface/UdpInterface.h"

namespace hermes {
namespace {

template <typename T>
Listener *makeServer(const InterfaceUrl &url, QObject *parent) {
    return new T(url, parent);
}

template <typename T>
Listener *makeSinglePeer(const InterfaceUrl &url, QObject *parent) {
    return new SinglePeerListener([url] { return new T(url, nullptr); }, parent);
}

} // namespace

// A new kind of carrier is one line here.
std::vector<InterfaceKind> &interfaceKinds() {
    using Reach = InterfaceKind::Reach;
    static std::vector<InterfaceKind> kinds = {
        {"tcp", Reach::Network, makeInterfaceOf<TcpInterface>, makeServer<TcpServerInterface>},
        {"tls", Reach::Certified, makeInterfaceOf<TlsInterface>, makeServer<TlsServerInterface>},
        {"local", Reach::Computer, makeInterfaceOf<LocalInterface>, makeServer<LocalServerInterface>},
        {"udp", Reach::Network, makeInterfaceOf<UdpInterface>, makeSinglePeer<UdpInterface>},
        {"serial", Reach::Computer, makeInterfaceOf<SerialInterface>, makeSinglePeer<SerialInterface>},
        {"pty", Reach::Computer, makeInterfaceOf<PtyInterface>, makeSinglePeer<PtyInterface>},
    };
    return kinds;
}

} // namespace hermes
