#pragma once

namespace hermes {

/// Now, in seconds of a clock that never jumps and goes on while the machine sleeps: for intervals only.
double bootNow();

} // namespace hermes
