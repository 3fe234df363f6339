#pragma once

#include "common/platform/BootClock.h"

namespace hermes {

/// Now, in seconds since the Unix epoch (the field `stamp` of every message). May jump when the clock is set.
double stampNow();

/// Now, in seconds of a clock that never jumps (the field `mono`): for intervals only.
double monotonicNow();

} // namespace hermes
