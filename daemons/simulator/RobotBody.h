#pragma once

#include "common/world/World.h"
#include "daemons/simulator/WheelBase.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"

#include <vector>

namespace hermes::simulator {

/// The people of a world: upright cylinders, each walking along its way and back. Who would come too near to
/// the robot waits, and after a while turns back. Time comes from outside.
class People {
public:
    using Vector = vectorlib::Vector2D<double>;
    struct Person {
        World::Person walk;
        double length = 0; ///< of the way; metres
        Vector position;
        double progress = 0; ///< along the way; metres
        bool forward = true; ///< to the end of the way, else back to its begin
        double waiting = 0;  ///< for the robot; seconds
    };

    static constexpr double radius = 0.25;   ///< metres
    static constexpr double height = 1.75;   ///< metres
    static constexpr double distance = 0.4;  ///< kept between the outlines of person and robot; metres
    static constexpr double longestWait = 2; ///< seconds, then one who waits turns back

    People() = default;
    /// They begin at the first points of their ways. robotRadius: of its outline; metres.
    People(const std::vector<World::Person> &walks, double robotRadius);

    /// Short steps: one is the way that a person makes without looking.
    void advance(double seconds, Vector robot);
    const std::vector<Person> &all() const { return people_; }

private:
    std::vector<Person> people_;
    double nearest_ = 0; ///< to the robot, centre to centre; metres
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
