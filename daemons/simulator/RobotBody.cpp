#include "daemons/simulator/RobotBody.h"

#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>

namespace hermes {

namespace {

using Vector = vectorlib::Vector2D<double>;

constexpr double smallAngle = 1e-4;

} // namespace

Twist WheelBase::twistOf(const std::array<double, 4> &wheels) const {
    const auto [fl, fr, rl, rr] = wheels;
    const double quarter = radius / 4;
    if (kind == Kind::Differential)
        return {quarter * (fl + fr + rl + rr), 0, quarter * (-fl + fr - rl + rr) / halfTrack};
    return {quarter * (fl + fr + rl + rr), quarter * (-fl + fr + rl - rr),
            quarter * (-fl + fr - rl + rr) / (halfBase + halfTrack)};
}

vectorlib::Pose2D RobotBody::move(const vectorlib::Pose2D &from, const Twist &twist, double seconds) {
    const double dx = twist.vx * seconds, dy = twist.vy * seconds, turn = twist.omega * seconds;
    // The exponential of the twist: exact for a constant one.
    const bool small = std::abs(turn) < smallAngle;
    const double a = small ? 1 - turn * turn / 6 : std::sin(turn) / turn;
    const double b = small ? turn / 2 : (1 - std::cos(turn)) / turn;
    const double ahead = a * dx - b * dy, left = b * dx + a * dy;
    const double c = std::cos(from.theta), s = std::sin(from.theta);
    Vector position(from.x + c * ahead - s * left, from.y + s * ahead + c * left);
    touching_ = false;
    for (const auto &wall : walls_) {
        if (wall.distance(position) >= radius_)
            continue;
        const Vector nearest =
            wall.begin() + wall.direction() * std::clamp(wall.along(position), 0.0, wall.length());
        const Vector outward = (position - nearest).normalized();
        position = nearest + (outward == Vector() ? wall.normal() : outward) * radius_;
        touching_ = true;
    }
    for (const auto &wall : walls_) { // in a corner narrower than the robot it stays where it was
        if (touching_ && wall.distance(position) < radius_ - 1e-9)
            position = {from.x, from.y};
    }
    return {position.x, position.y, vectorlib::wrapAngle(from.theta + turn)};
}

} // namespace hermes
