#pragma once

#include "gui/hermesctl/Arguments.h"
#include "protocol/messages/Motion.h"

#include <optional>

namespace hermes::ctl {

/// "vx", "vy", "omega".
const QStringList &velocityNames();

/// What the command line of `drive` says after the daemon; absent: no velocity, keys drive. Error: an unknown
/// name, one that is there twice, or no finite number.
Result<std::optional<Twist2D>> velocityOf(const Arguments &arguments);

} // namespace hermes::ctl
