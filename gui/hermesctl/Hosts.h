#pragma once

#include <QStringList>
#include <chrono>

namespace hermes::ctl {

/// Computers of daemons that hermesctl has reached: the last one first, each once, in a file of this user.
/// Loopback does not count.
void rememberHost(const QString &address);

/// Those, robots that keys were issued for here, and who announces itself on the network within the time.
QStringList knownHosts(std::chrono::milliseconds timeout);

} // namespace hermes::ctl
