#pragma once

#include "vectorlib/observation/Discrepancy.h"
#include "vectorlib/relations/RelationMatch.h"
#include "vectorlib/relations/TypedSegment.h"

#include <vector>

namespace hermes::vector {

/// How far matched segments lie apart. Pose-free thesis 6.3.
struct MatchedArea {
    double error = 0;  ///< between the segments of every pair, seen from the current pose; m^2
    double common = 0; ///< in front of both; m^2

    /// Of the error in the sum of both; 0 where nothing is shared.
    double percent() const { return error + common > 0 ? 100 * error / (error + common) : 0; }
};

/// The areas of all pairs at a pose that moves the current scan onto the reference.
class MatchedAreas {
public:
    MatchedArea operator()(const std::vector<vectorlib::CorrespondencePair> &pairs,
                           const std::vector<vectorlib::TypedSegment> &reference,
                           const std::vector<vectorlib::TypedSegment> &current,
                           const vectorlib::Transformation2D &pose) {
        const vectorlib::Transformation2D back = pose.inverse();
        MatchedArea area;
        for (const vectorlib::CorrespondencePair &p : pairs) {
            const auto r = back * reference[std::size_t(p.fixed)].segment;
            const auto &c = current[std::size_t(p.moving)].segment;
            if (!(r.begin().cross(r.end()) > 0) || !(c.begin().cross(c.end()) > 0))
                continue; // seen from behind
            expected_.assign(1, {r, 0});
            observed_.assign(1, {c, 0});
            const vectorlib::ViewComparison both = compare_(expected_, observed_);
            area.error += between(r, c);
            area.common += both.common;
        }
        return area;
    }

private:
    using Segment = vectorlib::LineSegment2D<double>;
    using Point = vectorlib::Vector2D<double>;

    static double triangle(Point a, Point b, Point c) { return std::abs((b - a).cross(c - a)) / 2; }
    // Of the quadrangle between two segments of one direction; of both triangles where they cross.
    static double between(const Segment &a, const Segment &b) {
        const double begin = a.across(b.begin()), end = a.across(b.end());
        if ((begin > 0) == (end > 0))
            return std::abs((b.end() - a.begin()).cross(b.begin() - a.end())) / 2;
        const Point cross = b.begin() + (b.end() - b.begin()) * (begin / (begin - end));
        return triangle(a.begin(), b.begin(), cross) + triangle(a.end(), b.end(), cross);
    }

    vectorlib::Discrepancy compare_;
    std::vector<vectorlib::VisiblePart<double>> expected_, observed_;
};

} // namespace hermes::vector
