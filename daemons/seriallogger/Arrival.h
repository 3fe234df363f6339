#pragma once

#include <cstdint>

namespace hermes::seriallogger {

/// When bytes came in, in nanoseconds: since the Unix epoch, and of a clock that never jumps.
struct Arrival {
    std::int64_t stamp_ns = 0;
    std::int64_t mono_ns = 0;

    static Arrival now();
    double stamp() const { return double(stamp_ns) * 1e-9; }
    double mono() const { return double(mono_ns) * 1e-9; }
};

} // namespace hermes::seriallogger
