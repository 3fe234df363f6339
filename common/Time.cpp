#include "common/Time.h"

#include <chrono>

namespace hermes {

namespace {

template <typename Clock>
std::int64_t now_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count();
}

} // namespace

double stampNow() {
    return double(now_ns<std::chrono::system_clock>()) * 1e-9;
}

double monotonicNow() {
    return double(now_ns<std::chrono::steady_clock>()) * 1e-9;
}

// This thread may have to wait between the two: the closest of three readings is as good as a microsecond.
Moment Moment::now() {
    Moment closest;
    std::int64_t gap_ns = INT64_MAX;
    for (int tries = 0; tries < 3 && gap_ns > 1000; ++tries) {
        const std::int64_t before = now_ns<std::chrono::steady_clock>();
        const std::int64_t stamp = now_ns<std::chrono::system_clock>();
        const std::int64_t after = now_ns<std::chrono::steady_clock>();
        if (after - before < gap_ns) {
            gap_ns = after - before;
            closest = {stamp, before + gap_ns / 2};
        }
    }
    return closest;
}

Moment Moment::ofMono(double mono) {
    const Moment at = now();
    const auto mono_ns = std::int64_t(mono * 1e9);
    return {at.stamp_ns + mono_ns - at.mono_ns, mono_ns};
}

} // namespace hermes
