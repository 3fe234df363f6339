#pragma once

#include "common/interface/SocketOwner.h"

#include <QByteArray>

namespace hermes {

/// As ownerOfSocket(), from the text of /proc/net/tcp or /proc/net/tcp6, proc(5).
std::optional<unsigned> ownerInSocketTable(const QByteArray &table, const SocketEnd &from,
                                           const SocketEnd &to);

} // namespace hermes
