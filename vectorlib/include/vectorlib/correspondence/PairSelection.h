#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CollinearBundles.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/correspondence/PotentialPair.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"
#include "vectorlib/registration/PointToLineRefinement.h"
#include "vectorlib/tls/TlsSums.h"

#include <vector>

namespace vectorlib {

/// The pairs that agree with a transformation, and the transformation that fits them best. From a combination
/// of bundles, which compares lines far from their segments (erratum 13), to where the segments themselves
/// lie on each other: all points of the dynamic segments on the static lines, in a few Gauss-Newton steps
/// while the gate narrows. Keeps its buffers.
class PairSelection {
public:
    using Segments = std::vector<LineSegment2D<double>>;

    double wideDistance = 0.20; ///< root mean square distance of a pair at first; metres
    double distance = 0.06;     ///< and at last
    double wideAngle = 0.17;    ///< between the segments of a pair at first; radians
    double angle = 0.10;        ///< and at last
    double overlap = 0.3;       ///< least share of the shorter segment beside the other
    int steps = 4;

    /// Improves the transformation; its pairs are in pairs().
    Transformation2D operator()(const std::vector<PotentialPair> &candidates, const Segments &fixed,
                                const Segments &moving, Transformation2D t);
    const std::vector<CorrespondencePair> &pairs() const { return pairs_; }

    /// The energy (7.44) that is left between two segments of a pair, by the angle between them and their
    /// distance in the middle of the dynamic one; m^2. At the middle, since the sums of a registration
    /// compare the lines beside the origin, where a short line far away is not known (erratum 13).
    static double energy(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moved,
                         const Stiffness &stiffness);

private:
    static const LineSegment2D<double> &at(const Segments &segments, int i) {
        return segments[static_cast<std::size_t>(i)];
    }
    // As of points spread evenly over the segment, one a metre.
    static TlsSums sumsOf(const LineSegment2D<double> &s);
    void choose(const std::vector<PotentialPair> &candidates, const Segments &fixed, const Segments &moving,
                const Transformation2D &t, double gate, double turn);

    std::vector<CorrespondencePair> pairs_;
    PointToLineRefinement refinement_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/PairSelection.cpp")
