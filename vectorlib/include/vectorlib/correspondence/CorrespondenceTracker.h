#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CollinearBundles.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/correspondence/PotentialPairs.h"
#include "vectorlib/correspondence/Votes.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"
#include "vectorlib/registration/PointRefinement.h"
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

/// Settings of CorrespondenceTracker: which pairs it takes, and how far it trusts the expected pose.
struct TrackingSettings {
    /// Of the expected pose (matcher.permitted_m of the daemon): the first gate, which narrows to
    /// finalDistance and finalAngle.
    PermittedError permitted = {0.5, 0.5, 0.4};
    double finalDistance =
        0.10;                 ///< root mean square distance from the line beyond which a pair is none; metres
    double finalAngle = 0.17; ///< the same for the angle between the segments; radians
    double minOverlap = 0.2;  ///< share of the shorter segment that must lie over the other
    /// How far the expected pose may be wrong, a standard deviation; decides where the lines leave a
    /// direction open. Metres.
    double expectedDeviationXY = 0.05;
    double expectedDeviationAlpha = 0.10; ///< the same of its heading; radians
    /// Standard deviation of one point from its static line, the line's own error included; weighs points
    /// against the expected pose. Metres.
    double pointDeviation = 0.15;
    std::size_t minPairs = 2;       ///< fewer pairs are no match
    double minMatchedShare = 0.15;  ///< of the length of all dynamic edges; with less there is no match
    int rotations = 3;              ///< how many likely rotations are tried beside the expected one
    int iterations = 12;            ///< most refinement steps for each
    double gateFactor = 0.6;        ///< how fast the gates narrow from the permitted error to the final ones
    double expectationScore = 0.05; ///< metres of matched length that one squared standard deviation costs

    /// For an expected pose that is hardly more than a guess: scans far apart, without odometry.
    static TrackingSettings forPoorExpectation();
};

/// Finds which edges of a scan correspond to which of the map, tracking from an expected pose.
///
/// Potential pairs come from the permitted set of transformations (thesis 7.4.1). From the expected pose, and
/// from the rotations that most pairs ask for, every dynamic edge takes its nearest potential partner while
/// the gate narrows; the pose follows from the points of all pairs by their sums. The start that explains the
/// most length wins. Reliability and ambiguity are those of the one-step registration of its pairs. Keeps its
/// buffers between calls.
class CorrespondenceTracker {
public:
    TrackingSettings settings;

    /// `fixed` in the map's frame, `moving` in the sensor's; `expected` moves the second onto the first.
    const Match &operator()(const std::vector<LineSegment2D<double>> &fixed,
                            const std::vector<EdgeRaw2D> &moving, const Transformation2D &expected);

private:
    const LineSegment2D<double> &fixedOf(const CorrespondencePair &p) const {
        return fixed_[static_cast<std::size_t>(p.fixed)];
    }
    const EdgeRaw2D &movingOf(const CorrespondencePair &p) const {
        return (*moving_)[static_cast<std::size_t>(p.moving)];
    }
    static double angleBetween(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving) {
        return std::atan2(moving.direction().cross(fixed.direction()),
                          moving.direction().dot(fixed.direction()));
    }

    void collectCandidates();
    // Follows the nearest pairs from a start to where they agree; leaves the final pairs in pairs_.
    Transformation2D track(Transformation2D correction);
    // For every dynamic edge its nearest potential partner within the gates.
    void choosePairs(const Transformation2D &correction, double gate, double angle);
    Transformation2D refine(const Transformation2D &correction);
    // Matched length, less the more the pairs lie apart and the farther the pose is from the expected one.
    double score(const Transformation2D &correction) const;
    void conclude(const Transformation2D &expected, const Transformation2D &correction);

    std::vector<LineSegment2D<double>> fixed_; // in the expected sensor frame
    const std::vector<EdgeRaw2D> *moving_ = nullptr;
    std::vector<CorrespondencePair> candidates_; // sorted by moving edge
    std::vector<CorrespondencePair> pairs_;
    std::vector<CorrespondencePair> bestPairs_;
    RotationVotes votes_;
    LineSegmentRegistration registration_;
    PointToLineRefinement refinement_;
    Match match_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/CorrespondenceTracker.cpp")
