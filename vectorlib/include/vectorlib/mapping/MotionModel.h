#pragma once

#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// Velocity in the sensor's own frame; m/s and rad/s.
struct Twist2D {
    double vx = 0;
    double vy = 0;
    double omega = 0;

    /// The motion over `seconds` at this velocity, along an arc.
    Transformation2D motion(double seconds) const {
        const double a = omega * seconds;
        // sin(a)/a and (1 - cos(a))/a, also for small a
        const double s = std::abs(a) < 1e-6 ? 1 - a * a / 6 : std::sin(a) / a;
        const double c = std::abs(a) < 1e-6 ? a / 2 : (1 - std::cos(a)) / a;
        return {(s * vx - c * vy) * seconds, (c * vx + s * vy) * seconds, a};
    }
    /// The velocity that makes this motion in `seconds`.
    static Twist2D between(const Transformation2D &motion, double seconds) {
        const double a = motion.alpha(), half = a / 2;
        const double k = std::abs(half) < 1e-6 ? 1 : half / std::tan(half);
        return {(k * motion.x() + half * motion.y()) / seconds,
                (k * motion.y() - half * motion.x()) / seconds, a / seconds};
    }
};

/// Where a sensor is expected next when it goes on as between its last two poses.
class MotionModel {
public:
    double maxGap =
        1.0; ///< after a longer pause, or a stamp that steps back, the velocity is forgotten; seconds
    double lastStepShare = 0.5; ///< of the last step in the velocity; less is smoother and later

    void update(const Pose2D &pose, double stamp) {
        const double seconds = stamp - stamp_;
        if (!known_ || !(seconds > 0) || seconds > maxGap) {
            twist_ = Twist2D();
            velocityKnown_ = false;
        } else {
            const Twist2D last =
                Twist2D::between(Transformation2D(pose_).inverse() * Transformation2D(pose), seconds);
            const double k = velocityKnown_ ? lastStepShare : 1;
            twist_ = {twist_.vx + k * (last.vx - twist_.vx), twist_.vy + k * (last.vy - twist_.vy),
                      twist_.omega + k * (last.omega - twist_.omega)};
            velocityKnown_ = true;
        }
        pose_ = pose;
        stamp_ = stamp;
        known_ = true;
    }
    /// Puts the sensor somewhere else, standing still.
    void reset(const Pose2D &pose) {
        pose_ = pose;
        twist_ = Twist2D();
        known_ = velocityKnown_ = false;
    }
    Pose2D predict(double stamp) const {
        const double seconds = stamp - stamp_;
        if (!known_ || !(seconds > 0) || seconds > maxGap)
            return pose_;
        return (Transformation2D(pose_) * twist_.motion(seconds)).pose();
    }
    const Pose2D &pose() const { return pose_; }
    /// Smoothed over the last steps; zero when unknown.
    const Twist2D &twist() const { return twist_; }

private:
    Pose2D pose_;
    Twist2D twist_;
    double stamp_ = 0;
    bool known_ = false;
    bool velocityKnown_ = false;
};

/// The middle between the first and the last of the points' times; 0 without any. The best time to refer a
/// scan to: a wrong velocity then bends the scan without shifting it, while at its beginning the shift would
/// come back as a wrong velocity of the next scan, and grow.
inline float middleTime(const std::vector<float> &seconds) {
    if (seconds.empty())
        return 0;
    const auto [first, last] = std::minmax_element(seconds.begin(), seconds.end());
    return (*first + *last) / 2;
}

/// Moves points measured while the sensor moved to where they would have been seen from its place at time
/// `reference`. `seconds` holds the time of each point; both of the same size, or no times for a scan
/// measured at once.
inline void compensateMotion(std::vector<Vector2D<float>> &points, const std::vector<float> &seconds,
                             float reference, const Twist2D &twist) {
    for (std::size_t i = 0; i < points.size() && i < seconds.size(); ++i)
        points[i] = twist.motion(seconds[i] - reference) * points[i];
}

} // namespace vectorlib
