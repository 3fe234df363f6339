#include "common/interface/InterfaceRegistry.h"

#include "common/interface/LocalInterface.h"
#include "common/interface/LocalServerInterface.h"
#include "common/interface/PtyInterface.h"
#include "common/interface/SerialInterface.h"
#include "common/interface/TcpInterface.h"
#include "common/interface/TcpServerInterface.h"
#include "common/interface/TlsInterface.h"
#include "common/interface/TlsServerInterface.h"
#include "common/interface/UdpInterface.h"

#include <QHostAddress>

namespace hermes {
namespace {

/// Who can be at the other end.
enum class Reach {
    Network,
    Certified, ///< of the network, who has a certificate
    Computer
};

struct Kind {
    const char *scheme;
    Reach reach;
    Interface *(*connect)(const InterfaceUrl &, QObject *);
    Listener *(*listen)(const InterfaceUrl &, QObject *);
};

template <typename T>
Interface *make(const InterfaceUrl &url, QObject *parent) {
    return new T(url, parent);
}

template <typename T>
Listener *makeServer(const InterfaceUrl &url, QObject *parent) {
    return new T(url, parent);
}

template <typename T>
Listener *makeSinglePeer(const InterfaceUrl &url, QObject *parent) {
    return new SinglePeerListener([url] { return new T(url, nullptr); }, parent);
}

// A new kind of carrier is one line here.
const Kind kinds[] = {
    {"tcp", Reach::Network, make<TcpInterface>, makeServer<TcpServerInterface>},
    {"tls", Reach::Certified, make<TlsInterface>, makeServer<TlsServerInterface>},
    {"local", Reach::Computer, make<LocalInterface>, makeServer<LocalServerInterface>},
    {"udp", Reach::Network, make<UdpInterface>, makeSinglePeer<UdpInterface>},
    {"serial", Reach::Computer, make<SerialInterface>, makeSinglePeer<SerialInterface>},
    {"pty", Reach::Computer, make<PtyInterface>, makeSinglePeer<PtyInterface>},
};

const Kind *findKind(const QString &scheme) {
    for (const Kind &kind : kinds) {
        if (scheme == QLatin1String(kind.scheme))
            return &kind;
    }
    return nullptr;
}

Error unknownScheme(const InterfaceUrl &url) {
    return Error(ErrorCode::InvalidParams,
                 QStringLiteral("address %1: unknown scheme \"%2\", known are: %3")
                     .arg(url.toString(), url.scheme, interfaceSchemes().join(QStringLiteral(", "))));
}

} // namespace

Result<Interface *> makeInterface(const InterfaceUrl &url, QObject *parent) {
    const Kind *kind = findKind(url.scheme);
    if (!kind)
        return unknownScheme(url);
    return kind->connect(url, parent);
}

Result<Listener *> makeListener(const InterfaceUrl &url, QObject *parent) {
    const Kind *kind = findKind(url.scheme);
    if (!kind)
        return unknownScheme(url);
    return kind->listen(url, parent);
}

bool isReachable(const InterfaceUrl &url) {
    const Kind *kind = findKind(url.scheme);
    return !(kind && kind->reach == Reach::Computer) && url.host != QStringLiteral("localhost") &&
           !QHostAddress(url.host).isLoopback();
}

bool isOpenToNetwork(const InterfaceUrl &url) {
    const Kind *kind = findKind(url.scheme);
    return isReachable(url) && !(kind && kind->reach == Reach::Certified);
}

QStringList interfaceSchemes() {
    QStringList schemes;
    for (const Kind &kind : kinds)
        schemes.append(QLatin1String(kind.scheme));
    return schemes;
}

} // namespace hermes
