#include "daemons/motorcontrol/WheelTracker.h"

#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hermes::motorcontrol {
namespace {

constexpr double silence_s = MotorController::lostAfter_s;
constexpr double shortestRun_s = 0.1; // no reading is so exact in its time

// Both counters begin again.
bool wasReset(const std::array<quint32, 2> &before, const std::array<quint32, 2> &now) {
    const auto isSmall = [](quint32 count) { return std::abs(qint64(qint32(count))) < 16; };
    return isSmall(now[0]) && isSmall(now[1]) && !(isSmall(before[0]) && isSmall(before[1]));
}

} // namespace

void WheelTracker::configure(const std::array<WheelMount, wheelCount> &wheels, double countsPerTurn,
                             double maxSpeed, double longestRun_s) {
    wheels_ = wheels;
    radiansPerCount_ = 2 * vectorlib::pi / countsPerTurn;
    maxSpeed_ = maxSpeed;
    longestRun_s_ = longestRun_s;
}

bool WheelTracker::isPlausible(double turn, double gap) const {
    return std::abs(turn) <= maxSpeed_ * std::clamp(gap, shortestRun_s, longestRun_s_);
}

std::optional<WheelMotion>
WheelTracker::update(const std::array<const drive::Readings *, controllerCount> &readings) {
    const auto count = std::find(readings.begin(), readings.end(), nullptr) - readings.begin();
    for (int i = 0; i < count; ++i) {
        if (readings[i]->countsTime <= times_[i])
            return std::nullopt;
    }
    const auto countsBefore = counts_;
    const auto timesBefore = times_;
    const auto setupsBefore = setups_;
    const auto restartsBefore = restarts_;
    for (int i = 0; i < count; ++i) {
        counts_[i] = readings[i]->counts;
        times_[i] = readings[i]->countsTime;
        setups_[i] = readings[i]->setups;
        restarts_[i] = readings[i]->restarts;
    }
    if (std::find(timesBefore.begin(), timesBefore.begin() + count, 0.0) != timesBefore.begin() + count)
        return std::nullopt;
    WheelMotion motion;
    motion.time = std::accumulate(times_.begin(), times_.begin() + count, 0.0) / count;
    motion.gap_s =
        motion.time - std::accumulate(timesBefore.begin(), timesBefore.begin() + count, 0.0) / count;
    for (int i = 0; i < wheelCount; ++i) {
        const WheelMount &wheel = wheels_[i];
        // The counters wrap modulo 2^32: the difference as a signed number is right.
        const auto counts =
            qint32(counts_[wheel.controller][wheel.motor] - countsBefore[wheel.controller][wheel.motor]);
        const double gap = times_[wheel.controller] - timesBefore[wheel.controller];
        motion.turns[i] = wheel.sign * counts * radiansPerCount_;
        motion.speeds[i] = motion.turns[i] / gap;
        const bool wasSilent = gap > silence_s || setups_[wheel.controller] != setupsBefore[wheel.controller];
        const bool reset = restarts_[wheel.controller] != restartsBefore[wheel.controller] ||
                           (wasSilent && wasReset(countsBefore[wheel.controller], counts_[wheel.controller]));
        motion.plausible = motion.plausible && !reset && isPlausible(motion.turns[i], gap);
    }
    if (!motion.plausible)
        motion.turns = motion.speeds = {};
    return motion;
}

} // namespace hermes::motorcontrol
