#include "daemons/motorcontrol/MotionLimits.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {

WheelValues saturated(const WheelValues &speeds, double wheelSpeed) {
    double over = 1;
    for (double speed : speeds)
        over = std::max(over, std::abs(speed) / wheelSpeed);
    WheelValues result{};
    for (int i = 0; i < wheelCount; ++i)
        result[i] = speeds[i] / over;
    return result;
}

WheelValues ramped(const WheelValues &current, const WheelValues &target, const WheelLayout &layout,
                   const Twist2D &acceleration, double dt) {
    WheelValues way{};
    for (int i = 0; i < wheelCount; ++i)
        way[i] = target[i] - current[i];
    const Twist2D change = layout.twist(way);
    // Cycles of dt that the way takes; below 1 it is done at once.
    double cycles = std::max({1.0, std::abs(change.vx) / (acceleration.vx * dt),
                              std::abs(change.vy) / (acceleration.vy * dt),
                              std::abs(change.omega) / (acceleration.omega * dt)});
    // The front right wheel of every layout adds the three up.
    const double wheelAcceleration = layout.wheelSpeeds(acceleration)[int(Wheel::FrontRight)];
    for (double step : way)
        cycles = std::max(cycles, std::abs(step) / (wheelAcceleration * dt));
    WheelValues result = target;
    if (cycles > 1) {
        for (int i = 0; i < wheelCount; ++i)
            result[i] = current[i] + way[i] / cycles;
    }
    return result;
}

} // namespace hermes::motorcontrol
