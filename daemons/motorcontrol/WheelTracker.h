#pragma once

#include "daemons/motorcontrol/MotorController.h"

#include <optional>

namespace hermes::motorcontrol {

/// What the wheels have done since the controllers were read before.
struct WheelMotion {
    WheelValues turns{};   ///< rad
    WheelValues speeds{};  ///< rad/s
    double time = 0;       ///< monotonic, of the readings
    double gap_s = 0;      ///< since the ones before
    bool plausible = true; ///< false: counters were reset or lost; turns are zero
};

/// Turns the counters of all controllers into motions of the wheels. While a line is silent the counters go
/// on, and what the wheels did is known afterwards. A controller that has lost its power begins at zero
/// again: that is found by its counters, or by a motion that no wheel can do.
class WheelTracker {
public:
    /// maxSpeed: rad/s that no wheel exceeds. longestRun_s: without commands for so long wheels stand, even
    /// if they had their largest speed: the controllers' time-out and the time that braking takes.
    void configure(const std::array<WheelMount, wheelCount> &wheels, double countsPerTurn, double maxSpeed,
                   double longestRun_s = 1);

    /// Of as many controllers as there are, then nullptr. Nothing until each has been read again, or at the
    /// first reading.
    std::optional<WheelMotion> update(const std::array<const drive::Readings *, controllerCount> &readings);

private:
    bool isPlausible(double turn, double gap) const;

    std::array<WheelMount, wheelCount> wheels_;
    double radiansPerCount_ = 0;
    double maxSpeed_ = 0, longestRun_s_ = 1;
    std::array<std::array<quint32, 2>, controllerCount> counts_{};
    std::array<double, controllerCount> times_{}; // 0: not read yet
    std::array<int, controllerCount> setups_{}, restarts_{};
};

} // namespace hermes::motorcontrol
