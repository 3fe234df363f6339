#pragma once

#include "common/interface/InterfaceUrl.h"

#include <optional>

namespace hermes {

/// Where a daemon that listens at a TCP address of this computer listens, too, for programs of its own user:
/// the abstract Unix socket `hermes:HOST:PORT`. Nothing: the address is not on loopback.
std::optional<InterfaceUrl> ownSocketOf(const InterfaceUrl &tcp);

/// A connected socket to it; -1 when there is none, or when it is neither this user's nor root's; and on
/// Windows, which has no abstract names.
int connectToOwnSocket(const InterfaceUrl &tcp);

} // namespace hermes
