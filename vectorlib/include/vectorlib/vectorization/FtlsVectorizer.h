#pragma once

#include "vectorlib/vectorization/BlockSums.h"
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
        const double variance = settings.variance();
        cuts_.assign(1, sums_.atBorder(0));
        // A line is made as soon as the next one is known not to change it: the processor does both at a
        // time.
        while (cuts_.back().index < count) {
            const Position end = longest(cuts_.back(), variance);
            if (cuts_.size() > 1 && end.index < count)
                addLine(points, cuts_[cuts_.size() - 2], cuts_.back());
            cuts_.push_back(end);
        }
        giveLastLineTwoPoints(variance);
        for (std::size_t i = lines_.size(); i + 1 < cuts_.size(); ++i)
            addLine(points, cuts_[i], cuts_[i + 1]);
        if (settings.polyline)
            join_(points, sums_, settings, lines_);
        return lines_;
    }

    /// The instruction set to use, instead of the best there is.
    void level(simd::Level level) { sums_.level = level; }
    /// The sums of the last cluster, for those who refine its lines.
    const BlockSums<Scalar> &sums() const { return sums_; }

private:
    using Position = typename BlockSums<Scalar>::Position;

    // The end of the line that begins at `first`: figure 6.5 among the borders of blocks, then point by point
    // through the block where that lands. Two points always fit.
    Position longest(const Position &first, double variance) const {
        const std::size_t blocks = sums_.blocks();
        if (sums_.fitBorder(first, blocks, variance))
            return sums_.atBorder(blocks);
        std::size_t good = first.index / BlockSums<Scalar>::block, bad = blocks;
        while (bad - good > 1) {
            const std::size_t middle = good + (bad - good) / 2;
            (sums_.fitBorder(first, middle, variance) ? good : bad) = middle;
        }
        const Position end = sums_.extend(first, good, variance);
        // Where sigma is nearly 0, rounding of the sums can part two points that (nearly) coincide.
        return end.index < first.index + 2 ? sums_.at(std::min(first.index + 2, sums_.size())) : end;
    }
    void addLine(PointSpan<Scalar> points, const Position &first, const Position &end) {
        lines_.push_back(makeLine(points, first.index, end.index - 1, sums_.between(first, end)));
        // At the edge of the threshold the exact sums have decided, and they are the ones to keep.
        if (lines_.back().sigma > settings.sigma)
            lines_.back() =
                makeLine(points, first.index, end.index - 1, sums_.exactSums(first.index, end.index));
    }
    // A single point left at the end has no line: it joins the line before, or takes a point from it.
    void giveLastLineTwoPoints(double variance) {
        const std::size_t cuts = cuts_.size();
        if (cuts < 3 || cuts_[cuts - 1].index - cuts_[cuts - 2].index != 1)
            return;
        const Position before = cuts_[cuts - 3];
        if (cuts_[cuts - 2].index - before.index == 2 || sums_.fit(before, cuts_[cuts - 1], variance))
            cuts_.erase(cuts_.end() - 2);
        else
            cuts_[cuts - 2] = sums_.at(cuts_[cuts - 2].index - 1);
    }

    BlockSums<Scalar> sums_;
    std::vector<Position> cuts_; // where lines begin; the last is the end
    std::vector<VectorizedLine> lines_;
    PolylineJoiner join_;
};

} // namespace vectorlib
