#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Twist2D.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
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

    struct Result {
        Twist2D twist;   ///< to be added to the velocity used
        double bend = 0; ///< how far this moves the points beside known edges, at most; metres
    };

    /// `points` in the sensor's frame at the time `reference`, to which they were straightened; `seconds` the
    /// time of each; `known` in the same frame as `points`. Zero where there is nothing to compare.
    Result operator()(PointSpan<float> points, const std::vector<float> &seconds, float reference,
                      const std::vector<LineSegment2D<double>> &known) {
        const std::size_t count = std::min(points.size(), seconds.size()), step = count / mostPoints + 1;
        const double xy = std::pow(deviation / deviationXY, 2),
                     alpha = std::pow(deviation / deviationAlpha, 2);
        Result result;
        Twist2D &twist = result.twist, pose; // the pose as a motion of one second
        reach_ = gate;
        for (int i = 0; i < iterations; ++i) {
            h_.setZero();
            h_.diagonal() << 1e-6, 1e-6, 1e-6, xy, xy, alpha;
            g_ << 0, 0, 0, xy * twist.vx, xy * twist.vy, alpha * twist.omega;
            result.bend = 0;
            const Transformation2D placed(pose.motion(1));
            for (std::size_t k = 0; k < count; k += step) {
                const Vector2D<double> point(points[k]);
                const double t = double(seconds[k] - reference);
                const Vector2D<double> moved = Transformation2D(twist.motion(t)) * point;
                if (add(placed * moved, t, known))
                    result.bend = std::max(result.bend, (moved - point).norm());
            }
            const Vector6 d = h_.ldlt().solve(-g_);
            if (!d.allFinite())
                return {};
            pose = {pose.vx + d(0), pose.vy + d(1), pose.omega + d(2)};
            twist = {twist.vx + d(3), twist.vy + d(4), twist.omega + d(5)};
            reach_ = std::max(lastGate, reach_ * gateFactor);
        }
        return result;
    }

private:
    using Vector6 = Eigen::Matrix<double, 6, 1>;

    // False where no edge is near.
    bool add(Vector2D<double> point, double t, const std::vector<LineSegment2D<double>> &known) {
        const LineSegment2D<double> *nearest = nullptr;
        double r = reach_;
        for (const LineSegment2D<double> &edge : known) {
            const double across = edge.across(point), along = edge.along(point);
            if (std::abs(across) < std::abs(r) && along >= 0 && along <= edge.length()) {
                nearest = &edge;
                r = across;
            }
        }
        if (!nearest)
            return false;
        const Vector2D<double> n = nearest->normal();
        const double u = point.cross(n), s = 3 * r / reach_, q = 1 / (1 + s * s), w = q * q;
        Vector6 j;
        j << n.x, n.y, u, t * n.x, t * n.y, t * u;
        h_.noalias() += w * j * j.transpose();
        g_ += (w * r) * j;
        return true;
    }

    Eigen::Matrix<double, 6, 6> h_;
    Vector6 g_;
    double reach_ = 0;
};

} // namespace vectorlib
