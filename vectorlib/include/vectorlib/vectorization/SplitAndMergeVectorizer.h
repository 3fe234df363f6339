#pragma once

#include "vectorlib/vectorization/PointElimination.h"
#include "vectorlib/vectorization/Polyline.h"

#include <vector>

namespace vectorlib {

/// Split and merge with least squares (Algorithm 1 of the pose-free thesis): a set of points farther from its
/// line than the tolerance is split at the farthest; then neighbours on one line are merged. Fewer than two
/// points give no line. Every point belongs to exactly one line; every line has at least two points, and
/// where it has more than three all lie within the tolerance. A point that is not finite makes its line and
/// those after it invalid. Keeps its buffers between calls.
template <typename Scalar = float>
class SplitAndMergeVectorizer {
public:
    PointEliminationSettings settings;

    /// The lines of one cluster, in the frame of its points; metres. Valid until the next call.
    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        lines_.clear();
        if (points.size() < 2)
            return lines_;
        sums_.assign(points);
        const double tolerance = settings.tolerance();
        split(points, tolerance);
        merge(points, tolerance);
        for (std::size_t i = 0; i + 1 < cuts_.size(); ++i)
            lines_.push_back(
                makeLine(points, cuts_[i], cuts_[i + 1] - 1, sums_.sums(cuts_[i], cuts_[i + 1])));
        if (settings.polyline)
            join_(points, sums_, settings, lines_);
        return lines_;
    }

private:
    struct Farthest {
        std::size_t point;
        double distance;
    };
    static Farthest farthest(PointSpan<Scalar> points, std::size_t first, std::size_t end,
                             const Line2D &line) {
        Farthest found{first, 0};
        for (std::size_t i = first; i < end; ++i) {
            const double distance = std::abs(line.signedDistance(Vector2D<double>(points[i])));
            if (distance > found.distance)
                found = {i, distance};
        }
        return found;
    }
    // Steps 1 to 5. Intervals wait on a stack, the first on top, so that cuts come in order.
    void split(PointSpan<Scalar> points, double tolerance) {
        cuts_.assign(1, 0);
        open_.assign(1, points.size()); // where waiting intervals end; each begins where the one before ends
        while (!open_.empty()) {
            const std::size_t first = cuts_.back(), end = open_.back();
            const std::size_t at = splitPoint(points, first, end, tolerance);
            if (at == first) {
                cuts_.push_back(end);
                open_.pop_back();
            } else {
                open_.push_back(at);
            }
        }
    }
    // Where points first .. end - 1 divide, or first when they stay one line. At the farthest point; when
    // that is one of the ends, where a split would divide nothing, at the point farthest from the chord
    // between the ends.
    std::size_t splitPoint(PointSpan<Scalar> points, std::size_t first, std::size_t end,
                           double tolerance) const {
        if (end - first < 4)
            return first;
        const Line2D line = fitLine(sums_.sums(first, end)).line;
        const Vector2D<double> begin(points[first]), last(points[end - 1]);
        Farthest far{first, 0};
        if (line.isValid()) {
            far = farthest(points, first, end, line);
            if (!(far.distance > tolerance))
                return first;
        } else if (sums_.fitWithin(first, end, tolerance * tolerance)) {
            return first; // no direction, but nothing to tell apart either
        }
        if (far.point < first + 2 || far.point > end - 2) {
            const Line2D chord = lineThrough(begin, last);
            far = chord.isValid() ? farthest(points, first, end, chord) : Farthest{(first + end) / 2, 0};
        }
        return std::clamp(far.point, first + 2, end - 2);
    }
    // Step 6: neighbours whose points together lie within the tolerance of one line become one.
    void merge(PointSpan<Scalar> points, double tolerance) {
        std::size_t kept = 1; // cuts_[0 .. kept) are final, but for the last, which may go
        for (std::size_t i = 2; i < cuts_.size(); ++i) {
            if (!isOneLine(points, cuts_[kept - 1], cuts_[i], tolerance))
                cuts_[kept++] = cuts_[i - 1];
        }
        cuts_[kept++] = points.size();
        cuts_.resize(kept);
    }
    bool isOneLine(PointSpan<Scalar> points, std::size_t first, std::size_t end, double tolerance) const {
        if (!sums_.fitWithin(first, end, tolerance * tolerance)) // the mean square exceeds no maximum
            return false;
        const Line2D line = fitLine(sums_.sums(first, end)).line;
        return line.isValid() && farthest(points, first, end, line).distance <= tolerance;
    }

    PrefixSums sums_;
    std::vector<std::size_t> cuts_; // where lines begin; the last is the number of points
    std::vector<std::size_t> open_;
    std::vector<VectorizedLine> lines_;
    PolylineJoiner join_;
};

} // namespace vectorlib
