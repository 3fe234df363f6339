#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/geometry/Twist2D.h"
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
    std::size_t mostPoints = 600; ///< of a scan with more, every n-th takes part
    double gate = 0.3;            ///< points farther from every edge take no part at first; metres
    double lastGate = 0.1;        ///< the same in the last steps
    double gateFactor = 0.7;      ///< how fast the one narrows to the other
    double deviation = 0.1;       ///< of one point; weighs points against the velocity used; metres
    double deviationXY = 0.5;     ///< of the velocity used; m/s
    double deviationAlpha = 1;    ///< the same; rad/s
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

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/motion/TwistCorrection.cpp")
