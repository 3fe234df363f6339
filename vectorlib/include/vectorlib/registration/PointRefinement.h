#pragma once

#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/registration/PointPairs.h"

#include <Eigen/Core>
#include <optional>

namespace vectorlib {

/// Where a scan is expected, and how far that may be wrong: standard deviations.
struct Expectation {
    Transformation2D pose;        ///< moves the moving scan onto the fixed one
    double deviationXY = 0.15;    ///< metres
    double deviationAlpha = 0.10; ///< radians
};

/// Settings of PointRefinement.
struct PointRefinementSettings {
    std::size_t mostPoints = 500; ///< of a scan with more, every n-th takes part
    double gate = 0.15;           ///< points farther apart are no pairs; metres
    double gateFactor = 0.6;      ///< how fast a wider first gate narrows to it
    double scale = 0.25;          ///< a residual of this share of the gate weighs a quarter
    double deviation = 0.14;      ///< of one point; weighs points against the expected pose; metres
    int sample = 3;               ///< every n-th point takes part until the steps are small
    double smallStep = 0.01;      ///< from here on all points do; metres, and radians
    double lastStep = 0.0015;     ///< with a smaller one the search ends; metres, and radians
    int iterations = 15;          ///< most steps
};

/// Brings the points of a scan onto those of another: Gauss-Newton steps on the distances of the points of
/// each from the walls through the nearest points of the other, with robust weights. Both ways, so that
/// neither scan's noisy walls prevail. Where the points say nothing, as along a corridor, the expected pose
/// decides. Keeps its buffers between calls.
class PointRefinement {
public:
    PointRefinementSettings settings;

    /// Takes two scans, each in its sensor's frame and in the order of ScanOrder; metres.
    void start(PointSpan<float> fixed, PointSpan<float> moving) {
        fixed_.build(fixed, settings.mostPoints);
        moving_.build(moving, settings.mostPoints);
    }
    /// The scans as they were taken.
    const ScanIndex &fixed() const { return fixed_; }
    const ScanIndex &moving() const { return moving_; }
    /// The transformation of the moving scan onto the fixed one, from one nearby. A first gate wider than
    /// that of the settings reaches farther, and costs more.
    Transformation2D operator()(Transformation2D pose, const Expectation &expected, double firstGate = 0) {
        int sample = std::max(1, settings.sample);
        double gate = std::max(firstGate, settings.gate);
        for (int i = 0; i < settings.iterations; ++i) {
            const bool narrow = gate <= settings.gate;
            pairUp(pose, gate, sample);
            const Transformation2D next = improved(pose, gate, expected);
            const Transformation2D step = pose.inverse() * next;
            const double size = std::max(step.translation().norm(), std::abs(step.sin()));
            pose = next;
            if (narrow && sample == 1 && size < settings.lastStep)
                break;
            if (narrow && size < settings.smallStep)
                sample = 1;
            gate = std::max(settings.gate, gate * settings.gateFactor);
        }
        return pose;
    }
    /// How well the scans agree when the moving one lies at the pose; by a sample of their points.
    PointAgreement agreement(const Transformation2D &pose) const {
        PointAgreement a;
        const int sample = std::max(1, settings.sample);
        a.add(moving_, pose, fixed_, settings.gate, sample);
        a.add(fixed_, pose.inverse(), moving_, settings.gate, sample);
        return a;
    }

private:
    void pairUp(const Transformation2D &pose, double gate, int sample) {
        const bool wide = gate > settings.gate;
        const float squaredGate = float(gate * gate);
        const auto partner = [&](const ScanIndex &scan, Vector2D<float> p) {
            return wide ? scan.nearest(p, squaredGate) : scan.nearestAhead(p, squaredGate);
        };
        pairs_.clear();
        forEachPair(fixed_, moving_, pose, sample, partner,
                    [this](const PointPair &pair) { pairs_.push_back(pair); });
    }
    // Sums over the pairs of weighted products of the derivatives with each other and with the residuals. The
    // unknowns are the translation and the rotation about the moving sensor, where both are least correlated.
    struct Sums {
        float xx = 0, xy = 0, xa = 0, yy = 0, ya = 0, aa = 0, x = 0, y = 0, a = 0;
    };
    Sums sumsAt(const Transformation2D &pose, double gate) const {
        const FloatMotion motion(pose);
        const float inverse = float(1 / (settings.scale * settings.scale * gate * gate));
        Sums s;
        for (const PointPair &pair : pairs_) {
            const Vector2D<float> n = pair.normal, turned = motion.rotate(pair.moving);
            const float r = pair.residual(turned, motion), u = turned.cross(n);
            const float q = 1 / (1 + r * r * inverse), w = q * q; // Geman and McClure
            s.xx += w * n.x * n.x;
            s.xy += w * n.x * n.y;
            s.xa += w * n.x * u;
            s.yy += w * n.y * n.y;
            s.ya += w * n.y * u;
            s.aa += w * u * u;
            s.x += w * n.x * r;
            s.y += w * n.y * r;
            s.a += w * u * r;
        }
        return s;
    }
    // The pose after one step; the same pose when the equations are singular.
    Transformation2D improved(const Transformation2D &pose, double gate, const Expectation &expected) const {
        const Sums s = sumsAt(pose, gate);
        const double kXY = std::pow(settings.deviation / expected.deviationXY, 2);
        const double kAlpha = std::pow(settings.deviation / expected.deviationAlpha, 2);
        const Vector2D<double> off = pose.translation() - expected.pose.translation();
        const double turn = (expected.pose.inverse() * pose).alpha();
        Eigen::Matrix3d h;
        h << s.xx + kXY, s.xy, s.xa, s.xy, s.yy + kXY, s.ya, s.xa, s.ya, s.aa + kAlpha;
        const Eigen::Vector3d g(s.x + kXY * off.x, s.y + kXY * off.y, s.a + kAlpha * turn);
        const std::optional<Eigen::Vector3d> back = solveSymmetric(h, g);
        if (!back)
            return pose;
        return {pose.x() - (*back)(0), pose.y() - (*back)(1), pose.alpha() - (*back)(2)};
    }

    ScanIndex fixed_, moving_;
    std::vector<PointPair> pairs_;
};

} // namespace vectorlib
