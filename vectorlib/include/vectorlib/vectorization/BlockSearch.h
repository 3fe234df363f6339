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

    void assign(PointSpan<float> points, double variance) {
        sums_.level = level;
        sums_.assign(points);
        variance_ = variance;
    }
    const BlockSums &sums() const { return sums_; }
    Vector2D<double> origin() const { return sums_.origin(); }
    Cut at(std::size_t index) const { return {index, sums_.row(index)}; }
    bool fits(const Cut &first, const Cut &end) const {
        return sums_.fits(first.index, first.row, end.index, end.row, variance_);
    }

    /// The end of the longest interval that begins at `first`.
    Cut ahead(const Cut &first) const { return farthest<false>(first); }
    /// The begin of the longest interval that ends before `end`; reversed points give reversed intervals.
    Cut back(const Cut &end) const { return farthest<true>(end); }

private:
    template <bool back>
    Cut farthest(const Cut &from) const {
        const bool isEveryPoint = sums_.stride() == 1;
#if defined(VECTORLIB_SIMD_AVX2)
        if (level == simd::Level::Avx2)
            return isEveryPoint ? blocks::farthestAvx2<1, back>(sums_, from, variance_)
                                : blocks::farthestAvx2<BlockSums::block, back>(sums_, from, variance_);
#endif
        return isEveryPoint ? blocks::farthest<1, back>(sums_, from, variance_)
                            : blocks::farthest<BlockSums::block, back>(sums_, from, variance_);
    }

    BlockSums sums_;
    double variance_ = 0;
};

} // namespace vectorlib
