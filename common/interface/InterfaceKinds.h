#pragma once

#include "common/interface/Interface.h"
#include "common/interface/InterfaceUrl.h"

#include <vector>

namespace hermes {

class Listener;

/// One kind of carrier.
struct InterfaceKind {
    /// Who can be at the other end.
    enum class Reach {
        Network,
        Certified, ///< of the network, who has a certificate
        Computer
    };

    const char *scheme;
    Reach reach;
    Interface *(*connect)(const InterfaceUrl &, QObject *);
    Listener *(*listen)(const InterfaceUrl &, QObject *); ///< null: programs of this system only connect
};

/// Those of this system. Windows has those that its programs connect by: tcp, tls and serial; no Unix
/// sockets, no pseudo-terminals, and nothing listens.
/// Tests put others in their places before anything is opened.
std::vector<InterfaceKind> &interfaceKinds();

/// For their tables.
template <typename T>
Interface *makeInterfaceOf(const InterfaceUrl &url, QObject *parent) {
    return new T(url, parent);
}

} // namespace hermes
