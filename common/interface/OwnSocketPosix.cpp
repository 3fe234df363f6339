#include "common/interface/OwnSocket.h"

#include "common/ServiceAccount.h"
#include "common/interface/LocalAddress.h"

#include <sys/socket.h>
#include <unistd.h>

namespace hermes {
namespace {

/// Anyone may take the name while no daemon runs. Root believes the service of this system, too.
bool isOwn(int descriptor) {
    ucred listener{};
    socklen_t size = sizeof listener;
    if (::getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &listener, &size) != 0)
        return false;
    const uid_t me = ::geteuid();
    return listener.uid == 0 || listener.uid == me ||
           ServiceAccount::hasMember(listener.uid, me == 0 ? listener.uid : me);
}

} // namespace

int connectToOwnSocket(const InterfaceUrl &tcp) {
    const auto own = ownSocketOf(tcp);
    const auto address = own ? LocalAddress::of(own->path) : Error(ErrorCode::InvalidParams, QString());
    if (!address)
        return -1;
    const int descriptor = LocalAddress::makeSocket();
    if (descriptor < 0)
        return -1;
    if (::connect(descriptor, address->get(), address->size()) == 0 && isOwn(descriptor))
        return descriptor;
    LocalAddress::closeSocket(descriptor);
    return -1;
}

} // namespace hermes
