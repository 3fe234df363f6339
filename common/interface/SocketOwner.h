#pragma once

#include <QHostAddress>
#include <optional>

namespace hermes {

/// One end of a TCP connection.
struct SocketEnd {
    QHostAddress address;
    quint16 port = 0;
};

/// The user whose program of this computer has the connection from one end to the other: Linux, sock_diag(7),
/// or /proc/net/tcp where that is missing. Nothing: no such socket here, its program has closed it, or
/// the system does not tell, as Windows.
std::optional<unsigned> ownerOfSocket(const SocketEnd &from, const SocketEnd &to);

} // namespace hermes
