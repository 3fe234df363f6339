#include "protocol/scan/HostClock.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace hermes::scan {

namespace {

constexpr std::int64_t second_ns = 1000000000;
constexpr std::int64_t parted_ns = second_ns;  // clocks that part by more were set
constexpr std::int64_t stepped_ns = 50000000;  // no drift is so fast
constexpr std::int64_t unknown_ns = 100000000; // the bound as long as little is known

} // namespace

HostClock::Time HostClock::begin(std::int64_t measured_ns) {
    started_ = true;
    sensor_ns_ = 0;
    seconds_ = 0;
    earliest_ns_ = offset_ns_ = measured_ns;
    before_ns_ = spread_ns_ = none;
    return {measured_ns, unknown_ns};
}

void HostClock::endSecond() {
    seconds_ = std::min(seconds_ + 1, 3);
    if (seconds_ > 2) { // the first was not whole
        spread_ns_ = std::abs(earliest_ns_ - before_ns_);
        steps_ += spread_ns_ > stepped_ns;
    }
    before_ns_ = std::exchange(earliest_ns_, none);
}

HostClock::Time HostClock::take(std::int64_t stamp_ns, std::int64_t receive_ns, std::int64_t duration_ns) {
    stamp_ns %= period_ns_;
    const std::int64_t last_ns = std::exchange(last_ns_, stamp_ns);
    std::int64_t passed_ns = stamp_ns - last_ns;
    if (passed_ns > period_ns_ / 2)
        passed_ns -= period_ns_;
    if (passed_ns < -period_ns_ / 2)
        passed_ns += period_ns_;
    const std::int64_t measured_ns = receive_ns - duration_ns;
    const std::int64_t behind_ns = measured_ns - (sensor_ns_ + passed_ns) - offset_ns_;
    const bool neverJumps = receiver_ == Receiver::NeverJumps;
    const bool mayBeLate = neverJumps && std::abs(passed_ns) < parted_ns;
    if (!started_ || (std::abs(behind_ns) > parted_ns && !mayBeLate)) {
        restarts_ += started_ && std::abs(passed_ns) > parted_ns;
        return begin(measured_ns);
    }
    sensor_ns_ += passed_ns;
    if (passed_ns > 0 && stamp_ns / second_ns != last_ns / second_ns)
        endSecond();
    earliest_ns_ = std::min(earliest_ns_, measured_ns - sensor_ns_);
    const std::int64_t reach_ns = std::max<std::int64_t>(passed_ns, 0) / 4;
    const std::int64_t left_ns = late_ns();
    const bool steps = neverJumps && std::abs(left_ns) > stepped_ns;
    offset_ns_ += steps ? left_ns : std::clamp(left_ns, -reach_ns, reach_ns);
    return {sensor_ns_ + offset_ns_, spread_ns_ == none ? unknown_ns : spread_ns_ + std::abs(left_ns)};
}

} // namespace hermes::scan
