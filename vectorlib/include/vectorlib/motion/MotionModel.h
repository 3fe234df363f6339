#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <Eigen/Core>

#include <vector>

namespace vectorlib {

/// How wrong the velocity was by which a scan was straightened. A scan that was moved too little or too much
/// is bent: what was measured early and what was measured late lie askew to what is known. Gauss-Newton steps
/// for pose and velocity on the distances of the points from known edges, weighted as by Geman and McClure;
/// where the edges tell nothing, the velocity used is taken to be right.
class TwistCorrection {
public:
    std::size_t maxPoints = 600; ///< of a scan with more, every n-th takes part
    double gate = 0.3;           ///< points farther from every edge take no part at first; metres
    double lastGate = 0.1;       ///< the same in the last steps
    double gateFactor = 0.7;     ///< how fast the one narrows to the other
    double deviation = 0.1;      ///< of one point; weighs points against the velocity used; metres
    double deviationXY = 0.5;    ///< of the velocity used; m/s
    double deviationAlpha = 1;   ///< the same; rad/s
    int iterations = 4;

    /// The correction of a velocity, and what it is worth.
    struct Result {
        Twist2D twist;   ///< to be added to the velocity used
        double bend = 0; ///< how far this moves the points beside known edges, at most; metres
    };

    /// `points` in the sensor's frame at the time `reference`, to which they were straightened; `seconds` the
    /// time of each; `known` in the same frame as `points`. Zero where there is nothing to compare.
    Result operator()(PointSpan<float> points, const std::vector<float> &seconds, float reference,
                      const std::vector<LineSegment2D<double>> &known);

private:
    using Vector6 = Eigen::Matrix<double, 6, 1>;

    // What is known of an edge without a point.
    struct Edge {
        Vector2D<double> normal, direction;
        double distance, from, to; // of the line from the origin; of the ends along the direction

        Edge(const LineSegment2D<double> &edge);
        double across(Vector2D<double> point) const { return normal.dot(point) - distance; }
    };

    // The edges of which each point that takes part is within `gate`: until it has moved by what its reach is
    // less than that, no other edge can be the nearest.
    void findNear(PointSpan<float> points, std::size_t count, std::size_t step);

    // False where no edge is near.
    bool add(const Edge *edge, const Edge *end, Vector2D<double> point, double t);

    // The sum that has t to the power k as a factor: a block of the normal equations.
    Eigen::Matrix3d sum(int k) const;

    std::vector<Edge> edges_, near_; // near_: of the n-th point from starts_[n] to starts_[n + 1]
    std::vector<std::size_t> starts_;
    Eigen::Matrix<double, 6, 3> sums_; // over the points: upper triangle of m m^T, by powers of t
    Vector6 g_;
    double reach_ = 0;
};

/// The middle between the first and the last of the points' times; 0 without any. The best time to refer a
/// scan to: a wrong velocity then bends the scan without shifting it, while at its beginning the shift would
/// come back as a wrong velocity of the next scan, and grow.
float middleTime(const std::vector<float> &seconds);

/// Moves points measured while the sensor moved to where they would have been seen from its place at time
/// `reference`. `seconds` holds the time of each point; both of the same size, or no times for a scan
/// measured at once.
void compensateMotion(std::vector<Vector2D<float>> &points, const std::vector<float> &seconds,
                      float reference, const Twist2D &twist);

/// Where a sensor is expected next when it goes on as between its last two poses.
class MotionModel {
public:
    double maxGap =
        1.0; ///< after a longer pause, or a stamp that steps back, the velocity is forgotten; seconds
    /// No robot is faster (m/s, rad/s): a step that would be tells of wrong stamps or poses, not of a
    /// velocity.
    static constexpr double fastest_mps = 30, fastest_radps = 20;
    /// Between stamps that are nearer, the noise of the poses tells more than the motion; seconds.
    double minGap = 0.005;
    double lastStepShare = 0.5; ///< of the last step in the velocity; less is smoother and later

    /// The sensor was at `pose` at the time `stamp`; seconds. A step that tells no velocity leaves the one of
    /// before.
    void update(const Pose2D &pose, double stamp);
    /// Puts the sensor somewhere else, standing still.
    void reset(const Pose2D &pose);
    /// All poses so far lie elsewhere: in another frame, or the map was corrected.
    void move(const Transformation2D &moved) { pose_ = (moved * Transformation2D(pose_)).pose(); }
    /// Where it is expected at the time `stamp`, seconds: the last pose where the velocity is not known.
    Pose2D predict(double stamp) const;
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

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/motion/MotionModel.cpp")
