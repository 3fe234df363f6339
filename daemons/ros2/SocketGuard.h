#pragma once

#include "common/Result.h"

#include <QStringList>
#include <set>

namespace hermes::ros2 {

/// Keeps networks out that were not named: DDS binds its sockets to all interfaces, and believes whoever
/// writes to them. Datagrams that come in over others than the interfaces that are named, and the loopback,
/// are dropped by the kernel.
class SocketGuard {
public:
    /// networks: names or addresses of interfaces. Notes the sockets that there are.
    explicit SocketGuard(const QStringList &networks);

    /// DeviceFault: one of the networks is none of this computer.
    Result<void> check() const;
    /// Guards all UDP sockets that this process has opened since. DeviceFault: there is no such interface, or
    /// the kernel refused.
    Result<void> guardNewSockets() const;

private:
    Result<std::set<unsigned>> interfaces() const;

    const QStringList networks_;
    const std::set<int> before_;
};

} // namespace hermes::ros2
