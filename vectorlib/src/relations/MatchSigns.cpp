#include "vectorlib/relations/MatchSigns.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY int MatchSigns::operator()(const std::vector<CorrespondencePair> &pairs,
                                          const std::vector<TypedSegment> &reference,
                                          const std::vector<TypedSegment> &current,
                                          const Transformation2D &pose) const {
    const auto lineOf = [&](const CorrespondencePair &p) -> const LineSegment2D<double> & {
        return reference[static_cast<std::size_t>(p.fixed)].segment;
    };
    int signs = 0;
    bool isOblique = false;
    for (auto p = pairs.begin(); p != pairs.end(); ++p) {
        signs += std::none_of(pairs.begin(), p, [&](const CorrespondencePair &other) {
            return isSameLine(lineOf(other), lineOf(*p));
        });
        isOblique = isOblique || !isSquare(lineOf(pairs.front()), lineOf(*p));
        signs += commonJumps(reference[static_cast<std::size_t>(p->fixed)],
                             current[static_cast<std::size_t>(p->moving)], pose);
    }
    return signs + (isOblique ? 1 : 0);
}

VECTORLIB_BODY bool MatchSigns::isSameLine(const LineSegment2D<double> &a,
                                           const LineSegment2D<double> &b) const {
    return std::abs(a.direction().cross(b.direction())) < std::sin(angle) &&
           std::abs(a.across(b.middle())) < distance;
}

VECTORLIB_BODY bool MatchSigns::isSquare(const LineSegment2D<double> &a,
                                         const LineSegment2D<double> &b) const {
    const double sine = std::abs(a.direction().cross(b.direction())),
                 cosine = std::abs(a.direction().dot(b.direction()));
    return std::min(sine, cosine) < std::sin(angle);
}

VECTORLIB_BODY int MatchSigns::commonJumps(const TypedSegment &r, const TypedSegment &c,
                                           const Transformation2D &pose) const {
    return isCommonJump(r.begin, r.segment.begin(), c.begin, pose * c.segment.begin()) +
           isCommonJump(r.end, r.segment.end(), c.end, pose * c.segment.end());
}

VECTORLIB_BODY bool MatchSigns::isCommonJump(const SegmentEnd &a, Vector2D<double> there, const SegmentEnd &b,
                                             Vector2D<double> here) const {
    const bool isCorner = a.type == EndType::Angle && b.type == EndType::Angle;
    return a.isEdge() && b.isEdge() && !isCorner && a.slack <= distance && b.slack <= distance &&
           (there - here).norm() <= 1.5 * distance;
}

} // namespace vectorlib
