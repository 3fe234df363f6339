#pragma once

#include "vectorlib/vectorization/BlockSearchAvx2.h"

namespace vectorlib {

/// The longest intervals that fit, on BlockSums: along the rows of the table, eight at a time, and then
/// through the block in which the interval ends. Where rows are borders of blocks: the farthest of eight rows
/// that fits, where the farthest of the eight does not. Where every point has a row: the last before eight
/// that do not. Two points always fit.
class BlockSearch {
public:
    simd::Level level = simd::bestLevel(); ///< the instruction set to use

    /// Takes the points of a cluster, and the variance that is permitted; m^2. The points must outlive the
    /// search.
    void assign(PointSpan<float> points, double variance) {
        sums_.level = level;
        sums_.assign(points);
        variance_ = variance;
    }
    const BlockSums &sums() const { return sums_; }
    Vector2D<double> origin() const { return sums_.origin(); }
    /// The cut before a point.
    Cut at(std::size_t index) const { return {index, sums_.row(index)}; }
    /// Whether the points between two cuts lie within the variance of their line.
    bool fits(const Cut &first, const Cut &end) const {
        return sums_.fits(first.index, first.row, end.index, end.row, variance_);
    }

    /// The end of the longest interval that begins at `first`, and the begin of the longest that ends before
    /// `end`; reversed points give reversed intervals.
    void findEnds(const Cut &first, const Cut &end, Cut &ahead, Cut &back) const {
        if (sums_.stride() == 1)
            find<1>(first, end, ahead, back);
        else
            find<BlockSums::block>(first, end, ahead, back);
    }

private:
    template <std::size_t stride>
    void find(const Cut &first, const Cut &end, Cut &ahead, Cut &back) const {
#if defined(VECTORLIB_SIMD_AVX2)
        if (level == simd::Level::Avx2)
            return blocks::findEndsAvx2<stride>(sums_, first, end, variance_, ahead, back);
#endif
        ahead = blocks::farthest<stride, false>(sums_, first, variance_);
        back = blocks::farthest<stride, true>(sums_, end, variance_);
    }

    BlockSums sums_;
    double variance_ = 0;
};

} // namespace vectorlib
