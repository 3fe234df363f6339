#pragma once

#include <QString>

namespace hermes::supervisor {

/// A process and whatever it has started, in whichever session or group: each has the name of the family in
/// its environment.
namespace ProcessFamily {

constexpr const char *variable = "HERMES_PROCESS_FAMILY";

/// Kills those that are left.
void end(const QString &name);

} // namespace ProcessFamily

} // namespace hermes::supervisor
