#include "common/interface/InterfaceKinds.h"

#include "common/interface/SerialInterface.h"
#include "common/interface/TcpInterface.h"
#include "common/interface/TlsInterface.h"

namespace hermes {

std::vector<InterfaceKind> &interfaceKinds() {
    using Reach = InterfaceKind::Reach;
    static std::vector<InterfaceKind> kinds = {
        {"tcp", Reach::Network, makeInterfaceOf<TcpInterface>, nullptr},
        {"tls", Reach::Certified, makeInterfaceOf<TlsInterface>, nullptr},
        {"serial", Reach::Computer, makeInterfaceOf<SerialInterface>, nullptr},
    };
    return kinds;
}

} // namespace hermes
