#pragma once

#include "vectorlib/tls/TlsSums.h"
#include "vectorlib/vectorization/Polyline.h"

#include <vector>

namespace vectorlib {

/// Incremental total least squares: points join the line one by one while its standard deviation is at most
/// sigma. Thesis 6.1.3, with running sums as in 6.5. Fewer than two points give no line. Every point belongs
/// to exactly one line; every line has at least two points. A point that is not finite makes its line
/// invalid. Keeps its buffers between calls.
template <typename Scalar = float>
class IncVectorizer {
public:
    VectorizerSettings settings;

    /// The lines of one cluster, in the frame of its points; metres. Valid until the next call.
    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        lines_.clear();
        if (points.size() < 2)
            return lines_;
        grow(points, settings.variance());
        giveLastLineTwoPoints(points, settings.variance());
        if (settings.polyline) {
            prefix_.assign(points);
            join_(points, prefix_, settings, lines_);
        }
        return lines_;
    }

private:
    void grow(PointSpan<Scalar> points, double variance) {
        std::size_t first = 0;
        Vector2D<double> origin(points.front()); // erratum 3
        PlainSums sums;
        for (std::size_t i = 0; i < points.size(); ++i) {
            PlainSums longer = sums;
            longer.add(points[i].x - origin.x, points[i].y - origin.y);
            if (longer.n > 2 && !longer.fitWithin(variance)) {
                lines_.push_back(makeLine(points, first, i - 1, sums.about(origin)));
                first = i;
                origin = Vector2D<double>(points[i]);
                longer = PlainSums();
                longer.add(0, 0);
            }
            sums = longer;
        }
        lines_.push_back(makeLine(points, first, points.size() - 1, sums.about(origin)));
    }
    // A single point left at the end has no line: it joins the line before, or takes a point from it.
    void giveLastLineTwoPoints(PointSpan<Scalar> points, double variance) {
        if (lines_.size() < 2 || lines_.back().first != lines_.back().last)
            return;
        const std::size_t last = lines_.back().last;
        lines_.pop_back();
        const std::size_t first = lines_.back().first;
        lines_.pop_back();
        const auto line = [&points](std::size_t from, std::size_t to) {
            return makeLine(points, from, to, TlsSums::of(points.begin() + from, points.begin() + to + 1));
        };
        const VectorizedLine both = line(first, last);
        if (last - first == 2 || both.sigma * both.sigma <= variance) {
            lines_.push_back(both);
        } else {
            lines_.push_back(line(first, last - 2));
            lines_.push_back(line(last - 1, last));
        }
    }

    std::vector<VectorizedLine> lines_;
    PrefixSums prefix_; // for the joiner only
    PolylineJoiner join_;
};

} // namespace vectorlib
