#pragma once

#include "common/daemon/Command.h"

#include <functional>

namespace hermes {

// What the commands source.* of all loggers have in common.

/// paused and delay_s of source.open.
Field pausedParam();
Field delayParam();

/// source.pause; the function lets the replay wait or go on, and gives the state of the source.
Command pauseCommand(const std::function<Result<QJsonValue>(bool)> &pause);

} // namespace hermes
