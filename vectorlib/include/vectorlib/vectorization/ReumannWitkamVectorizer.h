#pragma once

#include "vectorlib/vectorization/PointElimination.h"

#include <vector>

namespace vectorlib {

/// Reumann-Witkam: a strip from a kept point goes on until a point is farther from its middle than the
/// tolerance; the last point before that is kept and begins the next strip. Thesis 6.1.2. The lines run
/// through the points that are kept and form a polyline as they are. Fewer than two points give no line. A
/// point that is not finite is dropped; a line that begins or ends at one is invalid. Keeps its buffers
/// between calls.
template <typename Scalar = float>
class ReumannWitkamVectorizer {
public:
    /// Which point gives a strip its direction. Of a dense scan adjacent points lie nearer to each other than
    /// their noise, and strips along them point anywhere: then the first point beyond the tolerance serves.
    /// Whatever is nearer to the kept point lies in the strip in any case.
    enum class Direction { BeyondTolerance, NextPoint };

    PointEliminationSettings settings;
    Direction direction = Direction::BeyondTolerance;

    /// The lines of one cluster, in the frame of its points; metres. Valid until the next call.
    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        lines_.clear();
        const std::size_t count = points.size();
        if (count < 2)
            return lines_;
        const double tolerance = settings.tolerance();
        const Scalar limit = static_cast<Scalar>(tolerance * tolerance);
        const Scalar baseline = direction == Direction::NextPoint ? Scalar(0) : limit;
        kept_.assign(1, 0);
        while (kept_.back() + 1 < count)
            kept_.push_back(endOfStrip(points, kept_.back(), limit, baseline));
        linesThrough(points, kept_, settings, lines_);
        return lines_;
    }

private:
    // The last point in the strip along the line from point `first` through the next one that is farther from
    // it than the baseline; limit and baseline squared.
    static std::size_t endOfStrip(PointSpan<Scalar> points, std::size_t first, Scalar limit,
                                  Scalar baseline) {
        const std::size_t count = points.size();
        const Vector2D<Scalar> begin = points[first];
        Vector2D<Scalar> side;
        std::size_t i = first + 1;
        for (; i < count && !(side.squaredNorm() > baseline); ++i)
            side = points[i] - begin;
        const Scalar most = limit * side.squaredNorm();
        for (; i < count; ++i) {
            const Scalar across = side.cross(points[i] - begin);
            if (across * across > most)
                return i - 1;
        }
        return count - 1;
    }

    std::vector<std::size_t> kept_;
    std::vector<VectorizedLine> lines_;
};

} // namespace vectorlib
