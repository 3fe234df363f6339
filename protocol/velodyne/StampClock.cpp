#include "protocol/velodyne/StampClock.h"

namespace hermes::velodyne {

namespace {

constexpr std::int64_t second_ns = 1000000000;
constexpr std::int64_t hour_ns = 3600 * second_ns;
/// A clock set anew, or a sensor started anew, shows as a jump of the offset beyond this.
constexpr std::int64_t jump_ns = 60 * second_ns;

/// Of all times with these nanoseconds of the hour the one nearest to the reference.
std::int64_t nearest(std::int64_t ofHour_ns, std::int64_t reference_ns) {
    std::int64_t ahead = (ofHour_ns - reference_ns) % hour_ns;
    if (ahead > hour_ns / 2)
        ahead -= hour_ns;
    if (ahead < -hour_ns / 2)
        ahead += hour_ns;
    return reference_ns + ahead;
}

} // namespace

std::int64_t StampClock::absolute(std::uint32_t stamp_us, std::int64_t receive_ns) {
    const std::int64_t ofHour_ns = std::int64_t(stamp_us) * 1000;
    const std::int64_t expected_ns = receive_ns + (started_ ? offset_ns_ : 0);
    std::int64_t stamp_ns = nearest(ofHour_ns, expected_ns);
    const std::int64_t off_ns = stamp_ns - expected_ns;
    if (off_ns > jump_ns || off_ns < -jump_ns)
        stamp_ns = nearest(ofHour_ns, receive_ns);
    offset_ns_ = stamp_ns - receive_ns;
    started_ = true;
    return stamp_ns;
}

} // namespace hermes::velodyne
