#pragma once

#include "vectorlib/simd/Lanes.h"
#include "vectorlib/vectorization/BlockSums.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <algorithm>

/// The steps of BlockSearch; BlockSearchAvx2.h has the twins of those that test.
namespace vectorlib::blocks {

/// Of points and rows: those in front of the first are negative.
using Index = std::ptrdiff_t;

/// The threshold test (see ThresholdTest) without a bound of the rounding. The signs of n and of the sums may
/// all be changed: the interval may lie on either side of a cut.
inline bool fits(double n, const SumRow &s, double variance) {
    const double limit = n * variance;
    const double a = n * (s.xx - limit) - s.x * s.x, b = n * (s.yy - limit) - s.y * s.y;
    const double c = n * s.xy - s.x * s.y;
    return !((b > 0) & (a * b > c * c));
}

/// The farthest bit that is set, or `none`.
template <bool back>
Index farthestBit(unsigned bits, Index none) {
    return bits == 0 ? none : static_cast<Index>(back ? simd::lowestBit(bits) : simd::highestBit(bits));
}
/// Whether the search along the rows ends after these eight.
template <std::size_t stride, bool back>
bool isEnd(unsigned bits) {
    return stride == 1 ? bits == 0 : !(bits & (back ? 1u : 0x80u));
}
/// How many of the `count` points of a block that begins at `begin` fit anyway (ahead), or from which on
/// (back): two always do.
template <bool back>
Index sureIn(Index begin, Index count, Index from) {
    return back ? std::clamp<Index>(from - 2 - begin, 0, count)
                : std::clamp<Index>(from + 2 - begin, 0, count - 1);
}
/// Where two points end.
template <bool back>
std::size_t two(const BlockSums &sums, const Cut &from) {
    return back ? from.index - std::min<std::size_t>(from.index, 2) : std::min(from.index + 2, sums.size());
}
/// Gives an interval two points where there are numbers so large that no test tells.
template <bool back>
VECTORLIB_INLINE void giveTwo(const BlockSums &sums, const Cut &from, Cut &cut) {
    const std::size_t least = two<back>(sums, from);
    if (back ? cut.index > least : cut.index < least)
        cut = {least, sums.row(least)};
}

/// The farthest of bits 0 .. count - 1 of which the test holds, and no other.
template <bool back, typename Test>
unsigned farthestOnly(int count, Test test) {
    for (int i = back ? 0 : count - 1; back ? i < count : i >= 0; i += back ? 1 : -1)
        if (test(i))
            return 1u << i;
    return 0;
}
/// Bit i: whether the interval between a cut and row k + i of the table fits; of the farthest such row only.
template <std::size_t stride, bool back>
unsigned fittingRows(const BlockSums &sums, Index k, const Cut &from, double variance) {
    return farthestOnly<back>(8, [&](int i) {
        const Index index = std::clamp<Index>((k + i) * Index(stride), 0, Index(sums.size()));
        const double n = static_cast<double>(index - Index(from.index));
        return fits(n, sums.table().row(k + i) - from.row, variance);
    });
}

/// Which of the points 0, 4, .., 28 of a block comes just before the end (ahead) or the begin (back) of an
/// interval: by four, and bit i tells of point 4 i + 4. Ahead the whole block does not fit, back it does.
template <bool back>
Index chooseFour(unsigned bits, Index count, Index sure) {
    if (back)
        return std::min(farthestBit<true>(bits & 0x7f, 7), std::max<Index>(sure - 1, 0) / 4);
    return std::max(farthestBit<false>(bits & ((1u << ((count - 1) / 4)) - 1), -1) + 1, sure / 4);
}
/// How many points behind that, up to 3 ahead, and from 1 back: bit i tells of the (i + 1)-th.
template <bool back>
Index choosePoint(unsigned bits, Index four, Index count, Index sure) {
    if (back)
        return std::clamp<Index>(sure - 4 * four, 1, farthestBit<true>(bits & 7, 3) + 1);
    return std::max(
        farthestBit<false>(bits & 7 & ((1u << std::min<Index>(count - 1 - 4 * four, 3)) - 1), -1) + 1,
        sure - 4 * four);
}

/// From the border of block b into the block: ahead from its begin, or back from its end, which fits where
/// the other end does not. Tests every fourth point, and then three between, on float sums of offsets from
/// the block's middle.
template <bool back>
Cut intoBlock(const BlockSums &sums, Index b, const Cut &from, double variance) {
    const BlockSums::Point *const points = sums.points(static_cast<std::size_t>(b));
    const BlockSums::Point middle = points[BlockSums::block / 2];
    const Vector2D<double> origin = Vector2D<double>(middle) - sums.origin();
    const Index begin = b * Index(BlockSums::block);
    const Index count = std::min<Index>(Index(sums.size()) - begin, BlockSums::block);
    const Index sure = sureIn<back>(begin, count, Index(from.index));
    const double n = static_cast<double>(begin - Index(from.index));

    const simd::SumsOfFours s = simd::sumFours(&points->x, sums.level);
    SumRow fours[9];
    fours[0] = (sums.table().row(b) - from.row).inFrame(n, origin);
    for (int i = 0; i < 8; ++i)
        fours[i + 1] = fours[i] + SumRow{s.x[i], s.y[i], s.xx[i], s.yy[i], s.xy[i]};
    const auto fourFits = [&](int i) { return fits(n + 4 * i + 4, fours[i + 1], variance); };
    const Index four =
        chooseFour<back>(farthestOnly<back>(back ? 7 : int(count - 1) / 4, fourFits), count, sure);

    const double before = n + double(4 * four);
    SumRow rows[5];
    rows[0] = fours[four];
    for (int i = 0; i < 4; ++i) {
        const BlockSums::Point p = points[4 * four + i] - middle;
        rows[i + 1] = rows[i];
        rows[i + 1].add(static_cast<double>(p.x), static_cast<double>(p.y));
    }
    const auto pointFits = [&](int i) { return fits(before + i + 1, rows[i + 1], variance); };
    const int between = back ? 3 : int(std::min<Index>(count - 1 - 4 * four, 3));
    const Index in = choosePoint<back>(farthestOnly<back>(between, pointFits), four, count, sure);
    return {static_cast<std::size_t>(begin + 4 * four + in),
            from.row + rows[in].inFrame(before + double(in), -origin)};
}

/// See BlockSearch.
template <std::size_t stride, bool back>
Cut farthest(const BlockSums &sums, const Cut &from, double variance) {
    const Index at = Index(from.index), size = Index(stride), last = sums.lastRow();
    const Index start = back ? (at + size - 1) / size : at / size;
    Index good = stride > 1 ? start : start + (back ? -2 : 2);
    for (Index k = back ? start - 8 : start + 1; back ? good > 0 && k > -8 : good < last && k <= last;
         k += back ? -8 : 8) {
        const unsigned bits = fittingRows<stride, back>(sums, k, from, variance);
        const Index row = k + farthestBit<back>(bits, good - k);
        good = back ? std::min(good, row) : std::max(good, row);
        if (isEnd<stride, back>(bits))
            break;
    }
    if (back ? good <= 0 : good >= last)
        return back ? Cut{0, SumRow{}} : Cut{sums.size(), sums.table().row(last)};
    Cut cut{static_cast<std::size_t>(good), sums.table().row(good)};
    if (stride > 1) {
        cut = intoBlock<back>(sums, back ? good - 1 : good, from, variance);
        giveTwo<back>(sums, from, cut);
    }
    return cut;
}

} // namespace vectorlib::blocks
