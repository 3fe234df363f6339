#pragma once

#include "common/platform/BootClock.h"

#include <cstdint>

namespace hermes {

/// Now, in seconds since the Unix epoch (the field `stamp` of every message). May jump when the clock is set.
double stampNow();

/// Now, in seconds of a clock that never jumps (the field `mono`): for intervals only.
double monotonicNow();

/// When something was, by both clocks, in nanoseconds. Whoever stores a stamp stores both: the one tells
/// which day it was, the other how long ago, also when the clock was set since.
struct Moment {
    std::int64_t stamp_ns = 0;
    std::int64_t mono_ns = 0;

    static Moment now();
    /// The moment of a time of monotonicNow(), by what both clocks say now.
    static Moment ofMono(double mono);
    double stamp() const { return double(stamp_ns) * 1e-9; }
    double mono() const { return double(mono_ns) * 1e-9; }
};

} // namespace hermes
