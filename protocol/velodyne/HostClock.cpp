#include "protocol/velodyne/HostClock.h"

#include "protocol/velodyne/PacketDecoder.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace hermes::velodyne {

namespace {

constexpr std::uint32_t second_us = 1000000;
constexpr std::int64_t parted_ns = 1000000000; // clocks that part by more were set
constexpr std::int64_t stepped_ns = 50000000;  // no drift is so fast
constexpr std::int64_t unknown_ns = 100000000; // the bound as long as little is known

} // namespace

ClockChoice clockChoiceFromText(std::string_view text) {
    return text == "gps" ? ClockChoice::Gps : text == "host" ? ClockChoice::Host : ClockChoice::Auto;
}

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

HostClock::Time HostClock::take(std::uint32_t stamp_us, std::int64_t receive_ns, std::int64_t duration_ns) {
    const std::uint32_t last_us = std::exchange(last_us_, stamp_us % stampPeriod_us);
    const std::int64_t passed_ns =
        nearestHour(stamp_us, last_us * std::int64_t(1000)) - last_us * std::int64_t(1000);
    const std::int64_t measured_ns = receive_ns - duration_ns;
    if (!started_ || std::abs(measured_ns - (sensor_ns_ + passed_ns) - offset_ns_) > parted_ns) {
        restarts_ += started_ && std::abs(passed_ns) > parted_ns;
        return begin(measured_ns);
    }
    sensor_ns_ += passed_ns;
    if (passed_ns > 0 && last_us_ / second_us != last_us / second_us)
        endSecond();
    earliest_ns_ = std::min(earliest_ns_, measured_ns - sensor_ns_);
    const std::int64_t reach_ns = std::max<std::int64_t>(passed_ns, 0) / 4;
    const std::int64_t left_ns = std::min(earliest_ns_, before_ns_) - offset_ns_;
    offset_ns_ += std::clamp(left_ns, -reach_ns, reach_ns);
    return {sensor_ns_ + offset_ns_, spread_ns_ == none ? unknown_ns : spread_ns_ + std::abs(left_ns)};
}

} // namespace hermes::velodyne
