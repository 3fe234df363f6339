#include "common/interface/InterfaceRegistry.h"

#include "common/interface/InterfaceKinds.h"

#include <QHostAddress>

namespace hermes {
namespace {

using Kind = InterfaceKind;
using Reach = Kind::Reach;

const Kind *findKind(const QString &scheme) {
    for (const Kind &kind : interfaceKinds()) {
        if (scheme == QLatin1String(kind.scheme))
            return &kind;
    }
    return nullptr;
}

Error unknownScheme(const InterfaceUrl &url) {
    return Error(ErrorCode::InvalidParams,
                 QString("address %1: unknown scheme \"%2\", known are: %3")
                     .arg(url.toString(), url.scheme, interfaceSchemes().join(", ")));
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
    if (!kind->listen)
        return Error(
            ErrorCode::InvalidParams,
            QString("address %1: this system can connect to it, but not listen there").arg(url.toString()));
    return kind->listen(url, parent);
}

bool isReachable(const InterfaceUrl &url) {
    const Kind *kind = findKind(url.scheme);
    return !(kind && kind->reach == Reach::Computer) && url.host != "localhost" &&
           !QHostAddress(url.host).isLoopback();
}

bool isOpenToNetwork(const InterfaceUrl &url) {
    const Kind *kind = findKind(url.scheme);
    return isReachable(url) && !(kind && kind->reach == Reach::Certified);
}

QStringList interfaceSchemes() {
    QStringList schemes;
    for (const Kind &kind : interfaceKinds())
        schemes.append(QLatin1String(kind.scheme));
    return schemes;
}

} // namespace hermes
