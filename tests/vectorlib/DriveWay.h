#pragma once

#include <vectorlib/geometry/Angle.h>
#include <vectorlib/geometry/Pose2D.h>
#include <vectorlib/geometry/Vector2D.h>

/// The poses of a robot that drives straight from place to place and turns where it stands; metres, radians.
class DriveWay {
public:
    using Point = vectorlib::Vector2D<double>;

    /// A pose about every `step` metres and 0.3 rad.
    DriveWay(const vectorlib::Pose2D &start, double step)
        : step_(step)
        , poses_{start} {}

    void goTo(Point to) {
        constexpr double turn = 0.3; // radians
        const vectorlib::Pose2D begin = poses_.back();
        const Point from(begin.x, begin.y);
        const double length = (to - from).norm(), heading = std::atan2(to.y - from.y, to.x - from.x);
        const double wrong = std::remainder(heading - begin.theta, 2 * vectorlib::pi);
        const int turns = int(std::abs(wrong) / turn) + 1, steps = int(length / step_) + 1;
        for (int i = 1; i <= turns && std::abs(wrong) > 0.01; ++i)
            poses_.push_back({from.x, from.y, begin.theta + wrong * i / turns});
        for (int i = 1; i <= steps && length > 0.01; ++i) {
            const Point p = from + (to - from) * (double(i) / steps);
            poses_.push_back({p.x, p.y, heading});
        }
    }
    const std::vector<vectorlib::Pose2D> &poses() const { return poses_; }

private:
    double step_;
    std::vector<vectorlib::Pose2D> poses_;
};
