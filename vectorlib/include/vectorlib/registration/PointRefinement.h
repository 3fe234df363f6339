#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/ScanIndex.h"
#include "vectorlib/tls/TlsSums.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace vectorlib {

/// A point of one scan and the wall of the other on which it should lie.
struct PointPair {
    Vector2D<float> moving; ///< its own frame
    Vector2D<float> normal; ///< of the wall, fixed frame
    float offset;           ///< of the wall along the normal

    /// The distance of the moving scan's point from the wall along the normal; metres.
    float residual(Vector2D<float> turned, const FloatMotion &motion) const {
        return normal.dot(turned + motion.translation) - offset;
    }
};

/// Gives `each` the pairs of every n-th point of both scans when the moving one lies at the pose. `partner`
/// tells the number of the point of a scan that belongs to a point in that scan's frame, or -1. Most points
/// are paired twice, once as a point of either scan.
template <typename Partner, typename Each>
void forEachPair(const ScanIndex &fixed, const ScanIndex &moving, const Transformation2D &pose, int sample,
                 Partner partner, Each each) {
    const FloatMotion forth(pose), back(pose.inverse());
    for (int i = 0; i < moving.size(); i += sample)
        if (const int k = partner(fixed, forth * moving.point(i)); k >= 0)
            each(PointPair{moving.point(i), fixed.normal(k), fixed.normal(k).dot(fixed.point(k))});
    for (int i = 0; i < fixed.size(); i += sample)
        if (const int k = partner(moving, back * fixed.point(i)); k >= 0) {
            const Vector2D<float> normal = forth.rotate(moving.normal(k));
            each(PointPair{moving.point(k), normal, normal.dot(fixed.point(i))});
        }
}

/// One Gauss-Newton step that brings the points of dynamic edges onto the lines of static ones: the sum of
/// squared distances of all points, computed from their sums alone, so that a pair costs the same whatever
/// its points.
///
/// With a unit normal n of the static line and a point x, the residual is r = n.(x + t + alpha x') - n.s,
/// where x' is x turned by +90 degrees and s any point of the static line. For a small alpha this is linear
/// in (t, alpha); the normal equations need only the count, mean and second moments of the points.
class PointToLineRefinement {
public:
    /// A prior that the step is zero; standard deviations in metres and radians, relative to noise of 1
    /// metre.
    void start(double weightXY, double weightAlpha) {
        h_ = Eigen::Vector3d(weightXY, weightXY, weightAlpha).asDiagonal();
        g_.setZero();
    }
    /// Points with `sums` belong onto `fixed`. Working frame: near the sensor.
    void add(const LineSegment2D<double> &fixed, const TlsSums &sums, double weight) {
        accumulate(fixed, sums, weight, 1);
    }
    /// Static points with `sums` belong onto `moving`, which the step moves: to first order they move the
    /// other way.
    void addStatic(const LineSegment2D<double> &moving, const TlsSums &sums, double weight) {
        accumulate(moving, sums, weight, -1);
    }
    /// The step (to be multiplied from the left); identity when the equations are singular.
    Transformation2D step() const {
        const std::optional<Eigen::Vector3d> back = solveSymmetric(h_, g_);
        return back ? Transformation2D(-(*back)(0), -(*back)(1), -(*back)(2)) : Transformation2D();
    }
    const Eigen::Matrix3d &information() const { return h_; }

private:
    void accumulate(const LineSegment2D<double> &line, const TlsSums &sums, double weight, double sign);

    Eigen::Matrix3d h_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g_ = Eigen::Vector3d::Zero();
};

/// Where a scan is expected, and how far that may be wrong: standard deviations.
struct Expectation {
    Transformation2D pose;        ///< moves the moving scan onto the fixed one
    double deviationXY = 0.15;    ///< metres
    double deviationAlpha = 0.10; ///< radians
};

/// Settings of PointRefinement.
struct PointRefinementSettings {
    std::size_t maxPoints = 500; ///< of a scan with more, every n-th takes part
    double gate = 0.15;          ///< points farther apart are no pairs; metres
    double gateFactor = 0.6;     ///< how fast a wider first gate narrows to it
    double scale = 0.25;         ///< a residual of this share of the gate weighs a quarter
    double deviation = 0.14;     ///< of one point; weighs points against the expected pose; metres
    int sample = 3;              ///< every n-th point takes part until the steps are small
    double smallStep = 0.01;     ///< from here on all points do; metres, and radians
    double lastStep = 0.0015;    ///< with a smaller one the search ends; metres, and radians
    int iterations = 15;         ///< most steps
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
        fixed_.build(fixed, settings.maxPoints);
        moving_.build(moving, settings.maxPoints);
    }
    /// The scans as they were taken.
    const ScanIndex &fixed() const { return fixed_; }
    const ScanIndex &moving() const { return moving_; }
    /// The transformation of the moving scan onto the fixed one, from one nearby. A first gate wider than
    /// that of the settings reaches farther, and costs more.
    Transformation2D operator()(Transformation2D pose, const Expectation &expected, double firstGate = 0);
    /// How well the scans agree when the moving one lies at the pose; by a sample of their points.
    PointAgreement agreement(const Transformation2D &pose) const;

private:
    void pairUp(const Transformation2D &pose, double gate, int sample);
    // Sums over the pairs of weighted products of the derivatives with each other and with the residuals. The
    // unknowns are the translation and the rotation about the moving sensor, where both are least correlated.
    struct Sums {
        float xx = 0, xy = 0, xa = 0, yy = 0, ya = 0, aa = 0, x = 0, y = 0, a = 0;
    };
    Sums sumsAt(const Transformation2D &pose, double gate) const;
    // The pose after one step; the same pose when the equations are singular.
    Transformation2D improved(const Transformation2D &pose, double gate, const Expectation &expected) const;

    ScanIndex fixed_, moving_;
    std::vector<PointPair> pairs_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/PointRefinement.cpp")
