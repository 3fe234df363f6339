#pragma once

#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/relations/TypedSegment.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vectorlib {

/// How many measured things of matched segments agree. Three are needed to tell a place from its like: two
/// lines that cross at a right angle fit any corner of any room.
class MatchSigns {
public:
    double distance = 0.10;       ///< of equal lines and ends; metres
    double angle = 10 * pi / 180; ///< from parallel or square, within which it tells nothing; radians

    /// The number of different lines among the pairs, and of jumps at which a segment ends in both scans, and
    /// one if two lines are neither parallel nor square. A corner counts by its two lines. Quadratic in the
    /// pairs. The pose brings the current scan onto the reference.
    int operator()(const std::vector<CorrespondencePair> &pairs, const std::vector<TypedSegment> &reference,
                   const std::vector<TypedSegment> &current, const Transformation2D &pose) const {
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

private:
    bool isSameLine(const LineSegment2D<double> &a, const LineSegment2D<double> &b) const {
        return std::abs(a.direction().cross(b.direction())) < std::sin(angle) &&
               std::abs(a.across(b.middle())) < distance;
    }
    bool isSquare(const LineSegment2D<double> &a, const LineSegment2D<double> &b) const {
        const double sine = std::abs(a.direction().cross(b.direction())),
                     cosine = std::abs(a.direction().dot(b.direction()));
        return std::min(sine, cosine) < std::sin(angle);
    }
    int commonJumps(const TypedSegment &r, const TypedSegment &c, const Transformation2D &pose) const {
        return isCommonJump(r.begin, r.segment.begin(), c.begin, pose * c.segment.begin()) +
               isCommonJump(r.end, r.segment.end(), c.end, pose * c.segment.end());
    }
    bool isCommonJump(const SegmentEnd &a, Vector2D<double> there, const SegmentEnd &b,
                      Vector2D<double> here) const {
        const bool isCorner = a.type == EndType::Angle && b.type == EndType::Angle;
        return a.isEdge() && b.isEdge() && !isCorner && a.slack <= distance && b.slack <= distance &&
               (there - here).norm() <= 1.5 * distance;
    }
};

} // namespace vectorlib
