#include "common/interface/OwnSocket.h"

#include <QHostAddress>

namespace hermes {

std::optional<InterfaceUrl> ownSocketOf(const InterfaceUrl &tcp) {
    const QHostAddress host(tcp.host == QStringLiteral("localhost") ? QStringLiteral("127.0.0.1") : tcp.host);
    if (tcp.scheme != QStringLiteral("tcp") || !host.isLoopback() || tcp.port == 0)
        return std::nullopt;
    InterfaceUrl own = tcp; // with its options
    own.scheme = QStringLiteral("local");
    own.host.clear();
    own.port = 0;
    own.path = QStringLiteral("@hermes:%1:%2").arg(host.toString()).arg(tcp.port);
    return own;
}

} // namespace hermes
