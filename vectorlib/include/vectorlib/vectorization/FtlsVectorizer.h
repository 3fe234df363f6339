#pragma once

#include "vectorlib/vectorization/Polyline.h"

#include <vector>

namespace vectorlib {

/// Fast total least squares vectorization: the longest intervals of points within sigma of their line, found
/// by binary search over prefix sums. Thesis 6.3. The points are one continuous cluster in scanning order,
/// all finite. Fewer than two points give no line. Every point belongs to exactly one line; every line has at
/// least two points. Keeps its buffers between calls.
template <typename Scalar = float>
class FtlsVectorizer {
public:
    VectorizerSettings settings;

    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        lines_.clear();
        const std::size_t count = points.size();
        if (count < 2)
            return lines_;
        sums_.assign(points);
        const double variance = settings.sigma * settings.sigma;
        cuts_.assign(1, 0);
        while (cuts_.back() < count)
            cuts_.push_back(longest(cuts_.back(), count, variance));
        giveLastLineTwoPoints(variance);
        for (std::size_t i = 0; i + 1 < cuts_.size(); ++i)
            lines_.push_back(
                makeLine(points, cuts_[i], cuts_[i + 1] - 1, sums_.sums(cuts_[i], cuts_[i + 1])));
        if (settings.polyline)
            join_(points, sums_, settings, lines_);
        return lines_;
    }

    /// The prefix sums of the last cluster, for those who refine its lines.
    const PrefixSums &sums() const { return sums_; }

private:
    // The end of the line that begins at `first`: figure 6.5. Two points always fit, so the search cannot
    // fail.
    std::size_t longest(std::size_t first, std::size_t count, double variance) const {
        if (sums_.fitWithin(first, count, variance))
            return count;
        std::size_t good = std::min(first + 2, count), bad = count;
        while (bad - good > 1) {
            const std::size_t middle = good + (bad - good) / 2;
            (sums_.fitWithin(first, middle, variance) ? good : bad) = middle;
        }
        return good;
    }
    // A single point left at the end has no line: it joins the line before, or takes a point from it.
    void giveLastLineTwoPoints(double variance) {
        const std::size_t cuts = cuts_.size();
        if (cuts < 3 || cuts_[cuts - 1] - cuts_[cuts - 2] != 1)
            return;
        const std::size_t before = cuts_[cuts - 3];
        if (cuts_[cuts - 2] - before == 2 || sums_.fitWithin(before, cuts_[cuts - 1], variance))
            cuts_.erase(cuts_.end() - 2);
        else
            --cuts_[cuts - 2];
    }

    PrefixSums sums_;
    std::vector<std::size_t> cuts_; // where lines begin; the last is the number of points
    std::vector<VectorizedLine> lines_;
    PolylineJoiner join_;
};

} // namespace vectorlib
