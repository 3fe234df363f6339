#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

namespace hermes::velodyne {

/// Whose clock tells when a sensor measured: the sensor's, which a GPS sets; the receiver's; or the sensor's
/// once a GPS has set it, and the receiver's until then.
enum class ClockChoice { Gps, Host, Auto };

/// Of "gps" and "host"; Auto for all else.
ClockChoice clockChoiceFromText(std::string_view text);

/// When a sensor without GPS measured, by the receiver's clock. Such a sensor counts the microseconds of an
/// hour that begins anywhere, by a clock that drifts. Packets come late at times, and never early: the one
/// that came soonest of this second of the sensor's and the one before tells how the clocks lie. So a drift
/// is followed (1,000 ppm are off by 2 ms), and a receiver's clock that is set. The times move towards that
/// by a quarter of what passes at most, so that they keep their order; where the clocks part by more than a
/// second they jump. Who begins later gets the same after three seconds.
class HostClock {
public:
    struct Time {
        std::int64_t stamp_ns; ///< since the Unix epoch
        std::int64_t bound_ns; ///< how far that may be off, beside what all packets are late alike
    };

    /// When the first laser of a packet fired. receive_ns: when the packet came in, since the Unix epoch.
    /// duration_ns: of its firings, after which the sensor sends it.
    Time take(std::uint32_t stamp_us, std::int64_t receive_ns, std::int64_t duration_ns);
    /// The clocks parted by more than a second, as the sensor's stamps did not go on: it was started anew.
    std::uint64_t restarts() const { return restarts_; }
    /// A clock was set by less, which the earliest packets tell.
    std::uint64_t steps() const { return steps_; }

private:
    static constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();

    Time begin(std::int64_t measured_ns);
    void endSecond();

    bool started_ = false;
    std::uint32_t last_us_ = 0;
    std::int64_t sensor_ns_ = 0;      ///< since the first packet, by its clock; goes on over the hours
    std::int64_t offset_ns_ = 0;      ///< of the receiver's clock from it, that counts now
    int seconds_ = 0;                 ///< that have ended since it began, up to a few
    std::int64_t earliest_ns_ = none; ///< the least offset of this second
    std::int64_t before_ns_ = none;   ///< of the second before
    std::int64_t spread_ns_ = none;   ///< between the last two
    std::uint64_t restarts_ = 0, steps_ = 0;
};

} // namespace hermes::velodyne
