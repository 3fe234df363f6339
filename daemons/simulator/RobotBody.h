#pragma once

#include "daemons/simulator/People.h"
#include "protocol/messages/Motion.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"

#include <array>
#include <vector>

namespace hermes::simulator {

/// Four wheels under a robot, in the order front left, front right, rear left, rear right.
struct WheelBase {
    enum class Kind { Mecanum, Differential };

    Kind kind = Kind::Mecanum;
    double radius = 0.1;     ///< of a wheel; metres
    double halfBase = 0.25;  ///< centre to axle; metres
    double halfTrack = 0.25; ///< centre to the middle of a wheel; metres

    /// How the body moves when the wheels turn so fast (rad/s, positive forward) without slip. Least squares
    /// where they fight each other.
    Twist2D twistOf(const std::array<double, 4> &wheels) const;
};

/// The outline of a robot, a circle, that walls and people stop.
class RobotBody {
public:
    RobotBody() = default;
    RobotBody(const std::vector<vectorlib::LineSegment2D<double>> &walls, double radius)
        : walls_(walls)
        , radius_(radius) {}

    /// Where it comes to with this twist, along an arc. It slides along walls and people and never enters
    /// one.
    Pose2D move(const Pose2D &from, const Twist2D &twist, double seconds, const People &people = {});
    /// A wall or a person held it in the last move.
    bool isTouching() const { return touching_; }

private:
    bool enters(vectorlib::Vector2D<double> position, const People &people) const;

    std::vector<vectorlib::LineSegment2D<double>> walls_;
    double radius_ = 0.3;
    bool touching_ = false;
};

} // namespace hermes::simulator
