#pragma once

#include "vectorlib/correspondence/CollinearBundles.h"
#include "vectorlib/registration/PointToLineRefinement.h"

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
                                const Segments &moving, Transformation2D t) {
        for (int i = 0; i < steps; ++i) {
            const double wide = std::pow(0.5, i);
            choose(candidates, fixed, moving, t, std::max(distance, wideDistance * wide),
                   std::max(angle, wideAngle * wide));
            refinement_.start(1e-9, 1e-9);
            for (const CorrespondencePair &p : pairs_)
                refinement_.add(at(fixed, p.fixed), sumsOf(t * at(moving, p.moving)), 1);
            t = refinement_.step() * t;
        }
        choose(candidates, fixed, moving, t, distance, angle);
        return t;
    }
    const std::vector<CorrespondencePair> &pairs() const { return pairs_; }

    /// The energy (7.44) that is left between two segments of a pair, by the angle between them and their
    /// distance in the middle of the dynamic one; m^2. At the middle, since the sums of a registration
    /// compare the lines beside the origin, where a short line far away is not known (erratum 13).
    static double energy(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moved,
                         const Stiffness &stiffness) {
        const double turn =
            std::atan2(moved.direction().cross(fixed.direction()), moved.direction().dot(fixed.direction()));
        const double apart = fixed.across(moved.middle());
        return stiffness.alpha * turn * turn + stiffness.xy * apart * apart;
    }

private:
    static const LineSegment2D<double> &at(const Segments &segments, int i) {
        return segments[static_cast<std::size_t>(i)];
    }
    // As of points spread evenly over the segment, one a metre.
    static TlsSums sumsOf(const LineSegment2D<double> &s) {
        const double n = s.length(), moment = n * n * n / 12;
        const Vector2D<double> v = s.direction();
        TlsSums sums;
        sums.n = n;
        sums.mean = s.middle();
        sums.xx = moment * v.x * v.x;
        sums.xy = moment * v.x * v.y;
        sums.yy = moment * v.y * v.y;
        return sums;
    }
    void choose(const std::vector<PotentialPair> &candidates, const Segments &fixed, const Segments &moving,
                const Transformation2D &t, double gate, double turn) {
        pairs_.clear();
        for (const PotentialPair &c : candidates) {
            const LineSegment2D<double> &line = at(fixed, c.numbers.fixed);
            if (std::abs(wrapAngle(c.alpha - t.alpha())) > turn)
                continue;
            const LineSegment2D<double> moved = t * at(moving, c.numbers.moving);
            if (line.meanSquareAcross(moved) <= gate * gate &&
                line.overlap(moved) >= overlap * std::min(line.length(), moved.length()))
                pairs_.push_back(c.numbers);
        }
    }

    std::vector<CorrespondencePair> pairs_;
    PointToLineRefinement refinement_;
};

} // namespace vectorlib
