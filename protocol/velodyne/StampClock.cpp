#include "protocol/velodyne/StampClock.h"

namespace hermes::velodyne {

namespace {

constexpr std::int64_t hour_ns = 3600000000000;
/// A clock set anew, or a sensor started anew, shows as a jump of the offset beyond this.
constexpr std::int64_t jump_ns = 60000000000;

} // namespace

std::int64_t nearestHour(std::uint32_t stamp_us, std::int64_t reference_ns) {
    std::int64_t ahead = (std::int64_t(stamp_us) * 1000 - reference_ns) % hour_ns;
    if (ahead > hour_ns / 2)
        ahead -= hour_ns;
    if (ahead < -hour_ns / 2)
        ahead += hour_ns;
    return reference_ns + ahead;
}

std::int64_t StampClock::absolute(std::uint32_t stamp_us, std::int64_t receive_ns) {
    const std::int64_t expected_ns = following_ ? last_ns_ : receive_ns + (started_ ? offset_ns_ : 0);
    std::int64_t stamp_ns = nearestHour(stamp_us, expected_ns);
    const std::int64_t off_ns = stamp_ns - expected_ns;
    if (!following_ && (off_ns > jump_ns || off_ns < -jump_ns))
        stamp_ns = nearestHour(stamp_us, receive_ns);
    last_ns_ = stamp_ns;
    offset_ns_ = stamp_ns - receive_ns;
    started_ = true;
    return stamp_ns;
}

void StampClock::follow(std::int64_t utc_ns) {
    following_ = true;
    last_ns_ = utc_ns;
}

void StampClock::reset() {
    *this = StampClock();
}

} // namespace hermes::velodyne
