#pragma once

#include "vectorlib/vectorization/PrefixSums.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <vector>

namespace vectorlib {

/// Joins the consecutive lines of one cluster into a polyline: thesis 6.3.3, figure 6.6. Corners are the
/// intersections of neighbouring lines. Where an intersection lies farther than delta from the middle between
/// the two points at which one line changes to the next, the points of both lines are divided among three
/// lines; where that does not help either, both lines keep their own ends and the polyline is interrupted
/// there.
class PolylineJoiner {
public:
    /// `sums` are those of the points: PrefixSums or BlockSums.
    template <typename Scalar, typename Sums>
    void operator()(PointSpan<Scalar> points, const Sums &sums, const VectorizerSettings &settings,
                    std::vector<VectorizedLine> &lines) {
        joined_.clear();
        for (const VectorizedLine &next : lines) {
            if (!joined_.empty() && !join(points, joined_.back(), next, settings.delta)) {
                if (bridge(points, sums, next, settings))
                    continue;
            }
            joined_.push_back(next);
        }
        cutAtCorners(points, settings.delta);
        lines.swap(joined_);
    }

private:
    template <typename Scalar>
    static Vector2D<double> breakPoint(PointSpan<Scalar> points, const VectorizedLine &l,
                                       const VectorizedLine &m) {
        return (Vector2D<double>(points[l.last]) + Vector2D<double>(points[m.first])) * 0.5;
    }
    template <typename Scalar>
    static bool corner(PointSpan<Scalar> points, const VectorizedLine &l, const VectorizedLine &m,
                       double delta, Vector2D<double> &point) {
        return l.line.isValid() && m.line.isValid() && intersect(l.line, m.line, point) &&
               (point - breakPoint(points, l, m)).squaredNorm() <= delta * delta;
    }
    template <typename Scalar>
    static bool join(PointSpan<Scalar> points, const VectorizedLine &l, const VectorizedLine &m,
                     double delta) {
        Vector2D<double> point;
        return corner(points, l, m, delta, point);
    }
    // Replaces the last joined line and `next` by three lines when these fit and meet; the correction of
    // figure 6.6b.
    template <typename Scalar, typename Sums>
    bool bridge(PointSpan<Scalar> points, const Sums &sums, const VectorizedLine &next,
                const VectorizerSettings &settings) {
        const VectorizedLine previous = joined_.back();
        const std::size_t first = previous.first, count = next.last - first + 1;
        if (count < 6)
            return false;
        const std::size_t cut1 = first + count / 3, cut2 = first + 2 * count / 3;
        const double variance = settings.variance();
        if (!sums.fitWithin(first, cut1, variance) || !sums.fitWithin(cut1, cut2, variance) ||
            !sums.fitWithin(cut2, next.last + 1, variance))
            return false;
        // From exact sums: those that fitWithin() judges by.
        const auto line = [&points](std::size_t from, std::size_t end) {
            return makeLine(points, from, end - 1, TlsSums::of(points.begin() + from, points.begin() + end));
        };
        const VectorizedLine a = line(first, cut1), b = line(cut1, cut2), c = line(cut2, next.last + 1);
        const bool stillMeetsBefore = joined_.size() < 2 ||
                                      join(points, joined_[joined_.size() - 2], a, settings.delta) ||
                                      !join(points, joined_[joined_.size() - 2], previous, settings.delta);
        if (!stillMeetsBefore || !join(points, a, b, settings.delta) || !join(points, b, c, settings.delta))
            return false;
        joined_.back() = a;
        joined_.push_back(b);
        joined_.push_back(c);
        return true;
    }
    template <typename Scalar>
    void cutAtCorners(PointSpan<Scalar> points, double delta) {
        Vector2D<double> point;
        for (std::size_t i = 0; i + 1 < joined_.size(); ++i)
            if (corner(points, joined_[i], joined_[i + 1], delta, point)) {
                joined_[i].segment = {joined_[i].segment.begin(), point};
                joined_[i + 1].segment = {point, joined_[i + 1].segment.end()};
            }
    }

    std::vector<VectorizedLine> joined_;
};

} // namespace vectorlib
