#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace hermes::scan {

/// When a sensor without GPS measured, by the receiver's clock. Such a sensor counts the time of a period
/// that begins anywhere (an hour, 30 s), by a clock that drifts. Packets come late at times, and never early:
/// the one that came soonest of this second of the sensor's and the one before tells how the clocks lie. So a
/// drift is followed (1,000 ppm are off by 2 ms), and a receiver's clock that is set. The times move towards
/// that by a quarter of what passes at most, so that they keep their order; where the clocks part by more
/// than a second they jump. Who begins later gets the same after three seconds.
class HostClock {
public:
    struct Time {
        std::int64_t stamp_ns; ///< by the receiver's clock
        std::int64_t bound_ns; ///< how far that may be off, beside what all packets are late alike
    };

    /// What the receiver's clock does. Where that never jumps, packets that are late by seconds are just
    /// late, as the host was held up; and its times follow at once where the clocks part by more than 50 ms.
    enum class Receiver { MayBeSet, NeverJumps };

    /// After so long the sensor's stamps begin again.
    explicit HostClock(std::int64_t period_ns, Receiver receiver = Receiver::MayBeSet)
        : period_ns_(period_ns)
        , receiver_(receiver) {}

    /// When what a packet stamps was measured. receive_ns: when the packet came in.
    /// duration_ns: from the stamp until the sensor has sent it.
    Time take(std::int64_t stamp_ns, std::int64_t receive_ns, std::int64_t duration_ns);
    /// The clocks parted by more than a second, as the sensor's stamps did not go on: it was started anew.
    std::uint64_t restarts() const { return restarts_; }
    /// A clock was set by less, which the earliest packets tell.
    std::uint64_t steps() const { return steps_; }

private:
    static constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();

    Time begin(std::int64_t measured_ns);
    void endSecond();
    /// How much later the packets that come soonest come than its times say.
    std::int64_t late_ns() const { return std::min(earliest_ns_, before_ns_) - offset_ns_; }

    std::int64_t period_ns_;
    Receiver receiver_;
    bool started_ = false;
    std::int64_t last_ns_ = 0;        ///< the stamp before
    std::int64_t sensor_ns_ = 0;      ///< since the first packet, by its clock; goes on over the hours
    std::int64_t offset_ns_ = 0;      ///< of the receiver's clock from it, that counts now
    int seconds_ = 0;                 ///< that have ended since it began, up to a few
    std::int64_t earliest_ns_ = none; ///< the least offset of this second
    std::int64_t before_ns_ = none;   ///< of the second before
    std::int64_t spread_ns_ = none;   ///< between the last two
    std::uint64_t restarts_ = 0, steps_ = 0;
};

} // namespace hermes::scan
