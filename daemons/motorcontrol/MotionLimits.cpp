#include "daemons/motorcontrol/MotionLimits.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {
namespace {

double toward(double from, double to, double most) {
    return from + std::clamp(to - from, -most, most);
}

} // namespace

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
    const double wheelAcceleration = layout.largestSpeed(acceleration);
    for (double step : way)
        cycles = std::max(cycles, std::abs(step) / (wheelAcceleration * dt));
    WheelValues result = target;
    if (cycles > 1) {
        for (int i = 0; i < wheelCount; ++i)
            result[i] = current[i] + way[i] / cycles;
    }
    return result;
}

Bend bent(const Bend &current, const Bend &target, const WheelLayout &layout, const MotionLimits &limits,
          double dt) {
    const double before = layout.curvature(current.steering);
    // In a bend another speed is another rate of turn, too; what that leaves of alpha is for the steering.
    const double alpha = limits.acceleration.omega * dt, a = limits.acceleration.vx * dt;
    double speed =
        toward(current.speed, target.speed, before == 0 ? a : std::min(a, alpha / std::abs(before)));
    double curvature = layout.curvature(toward(current.steering, target.steering, limits.steeringRate * dt));
    const double left = std::max(0.0, alpha - std::abs((speed - current.speed) * before));
    if (speed != 0)
        curvature = toward(before, curvature, left / std::abs(speed));
    const double most = limits.velocity.omega;
    if (std::abs(speed * curvature) > most) {
        const double fine = std::max(std::abs(current.speed), most / std::abs(curvature));
        speed = std::copysign(std::min(std::abs(speed), fine), speed);
        curvature = std::clamp(curvature, -most / std::abs(speed), most / std::abs(speed));
    }
    return {speed, layout.steering(curvature)};
}

} // namespace hermes::motorcontrol
