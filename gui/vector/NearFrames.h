#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>
#include <vector>

namespace hermes::vector {

/// The frames in which the two sets of pairs are worked on: their own, or, where the segments lie so far from
/// the origin that an error of rotation would turn into one of translation (erratum 13), one with the origin
/// amid them.
class NearFrames {
public:
    explicit NearFrames(const std::vector<vectorlib::SegmentPair> &pairs)
        : fixed_(originNear(pairs, &vectorlib::SegmentPair::fixed))
        , moving_(originNear(pairs, &vectorlib::SegmentPair::moving)) {}

    vectorlib::SegmentPair toNear(const vectorlib::SegmentPair &p) const {
        return {shifted(p.fixed, fixed_), shifted(p.moving, moving_), p.weight};
    }
    /// The motion between the near frames for one between the given frames, and back.
    vectorlib::Transformation2D toNear(const vectorlib::Transformation2D &t) const {
        return shift(-fixed_) * t * shift(moving_);
    }
    vectorlib::Transformation2D fromNear(const vectorlib::Transformation2D &t) const {
        return shift(fixed_) * t * shift(-moving_);
    }

private:
    using Point = vectorlib::Vector2D<double>;
    using Segment = vectorlib::LineSegment2D<double>;

    static Point originNear(const std::vector<vectorlib::SegmentPair> &pairs,
                            Segment vectorlib::SegmentPair::*set) {
        Point middle;
        for (const vectorlib::SegmentPair &p : pairs)
            middle += (p.*set).middle() / static_cast<double>(pairs.size());
        double extent = 0;
        for (const vectorlib::SegmentPair &p : pairs)
            extent = std::max({extent, ((p.*set).begin() - middle).norm(), ((p.*set).end() - middle).norm()});
        return middle.norm() > 10 * extent ? middle : Point();
    }
    static Segment shifted(const Segment &s, Point origin) {
        return {s.begin() - origin, s.end() - origin, s.direction()};
    }
    static vectorlib::Transformation2D shift(Point by) { return {by.x, by.y, 0}; }

    Point fixed_, moving_;
};

} // namespace hermes::vector
