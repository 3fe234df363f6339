#pragma once

#include "vectorlib/vectorization/PointElimination.h"

#include <utility>
#include <vector>

namespace vectorlib {

/// Douglas-Peucker: an interval of points is divided at the point farthest from the segment between its ends
/// until none is farther than the tolerance. Thesis 6.1.2; not recursive, as in 6.5. The lines run through
/// the points that are kept and form a polyline as they are. Fewer than two points give no line. A point that
/// is not finite is never the farthest; a line that ends at one is invalid. Keeps its buffers between calls.
template <typename Scalar = float>
class DouglasPeuckerVectorizer {
public:
    PointEliminationSettings settings;

    /// The lines of one cluster, in the frame of its points; metres. Valid until the next call.
    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        lines_.clear();
        if (points.size() < 2)
            return lines_;
        const double tolerance = settings.tolerance();
        const Scalar limit = static_cast<Scalar>(tolerance * tolerance);
        kept_.assign(1, 0);
        open_.assign(1, {0, points.size() - 1});
        while (!open_.empty()) {
            const auto [first, last] = open_.back();
            const std::size_t split = farthest(points, first, last, limit);
            if (split == first) {
                kept_.push_back(last);
                open_.pop_back();
            } else {
                open_.back() = {split, last};
                open_.emplace_back(first, split);
            }
        }
        linesThrough(points, kept_, settings, lines_);
        return lines_;
    }

private:
    // The point between first and last that is farthest from their segment, or first when none is farther
    // than the limit (squared). Distances from the segment, not from its line: the ends of a closed contour
    // nearly coincide and their line says little.
    static std::size_t farthest(PointSpan<Scalar> points, std::size_t first, std::size_t last, Scalar limit) {
        const Vector2D<Scalar> begin = points[first], side = points[last] - begin;
        const Scalar length = side.squaredNorm();
        // Everything times the squared length: no division. A segment of no length leaves the plain distance.
        const Scalar scale = length > 0 ? length : Scalar(1);
        Scalar most = limit * scale;
        std::size_t found = first;
        for (std::size_t i = first + 1; i < last; ++i) {
            const Vector2D<Scalar> p = points[i] - begin;
            const Scalar along = p.dot(side), across = side.cross(p);
            Scalar distance = across * across;
            if (!(along > 0))
                distance = p.squaredNorm() * scale;
            else if (along > length)
                distance = (p - side).squaredNorm() * scale;
            if (distance > most) {
                most = distance;
                found = i;
            }
        }
        return found;
    }

    std::vector<std::size_t> kept_;
    std::vector<std::pair<std::size_t, std::size_t>>
        open_; // intervals still to be looked at, the first on top
    std::vector<VectorizedLine> lines_;
};

} // namespace vectorlib
