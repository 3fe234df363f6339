#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/PointAgreement.h"
#include "vectorlib/registration/PointPairs.h"
#include "vectorlib/registration/ScanIndex.h"

#include <vector>

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
    void start(PointSpan<float> fixed, PointSpan<float> moving);
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
