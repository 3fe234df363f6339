#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/simd/SumBlocksNeon.h"
#include "vectorlib/vectorization/SumTable.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// The sums of any interval of points, like PrefixSums. In small clusters a row for every point, in double.
/// In others rows at the borders of blocks of points only: offsets from the middle of each block are added up
/// in float by SIMD, the blocks' sums in double; an interval that begins or ends inside a block reads the
/// points of that block again. Refers to the points given: they must outlive it.
///
/// fitWithin() answers as exact sums would: float sums carry a bound of their rounding, and an interval whose
/// variance is nearer to the threshold than that (a few parts in a thousand) is added up anew in double.
class BlockSums {
public:
    using Point = Vector2D<float>;
    static constexpr std::size_t block = simd::blockPoints; ///< points
    // The float sums of a block carry at most 16 roundings of 2^-24 each. By Cauchy's inequality the moments
    // of an interval with scatter T, and with local scatter L about the middles of its blocks, are then off
    // by at most 16 * 2^-24 (L + 2 sqrt(2 (T + L) L)), and 2 sqrt(2 (T + L) L) <= (T + L) / 4 + 8 L. Twice
    // that for the eigenvalue: 5e-7 (T + 37 L).
    static constexpr double relativeError = 5e-7; ///< of the scatter of an interval

    simd::Level level = simd::bestLevel(); ///< the instruction set to use

    static constexpr std::size_t smallCluster = 512; ///< points up to which every point has a row

    /// Takes the points of a cluster.
    void assign(PointSpan<float> points) {
        points_ = points;
        const std::size_t count = points.size();
        stride_ = count <= smallCluster ? 1 : block;
        const std::size_t last = (count + stride_ - 1) / stride_;
        table_.reset(last + 4);
        table_.set(0, SumRow{});
        last_ = static_cast<std::ptrdiff_t>(last);
        if (count == 0)
            return;
        origin_ = Vector2D<double>(points.front());
        if (stride_ == 1)
            sumPoints();
        else
            sumBlocks(last);
        table_.repeat(last_);
    }

    std::size_t size() const { return points_.size(); }
    PointSpan<float> points() const { return points_; }
    Vector2D<double> origin() const { return origin_; }
    /// How many points there are between two rows: 1 or `block`.
    std::size_t stride() const { return stride_; }
    /// Row i: the sums before point i stride(), or all when there are no more points.
    const SumTable &table() const { return table_; }
    std::ptrdiff_t lastRow() const { return last_; }
    /// The points of block b; where it is not full its middle follows again and again.
    const Point *points(std::size_t b) const {
        return b < points_.size() / block ? points_.begin() + b * block : lastBlock_;
    }

    /// The sums before point i.
    SumRow row(std::size_t i) const {
        SumRow row = table_.row(static_cast<std::ptrdiff_t>(i / stride_));
        for (std::size_t k = i / stride_ * stride_; k < i; ++k)
            addTo(row, k);
        return row;
    }
    /// The same cut at another place.
    Cut moved(const Cut &cut, std::size_t to) const {
        const std::size_t from = std::min(to, cut.index), end = std::max(to, cut.index);
        if (stride_ == 1 || end - from > block / 2)
            return {to, row(to)};
        const SumRow between = exactRow(from, end);
        return {to, to > cut.index ? cut.row + between : cut.row - between};
    }
    /// Adds point i to the sums before it.
    void addTo(SumRow &row, std::size_t i) const {
        row.add(static_cast<double>(points_[i].x) - origin_.x, static_cast<double>(points_[i].y) - origin_.y);
    }
    /// The sums of points first .. end - 1; end > first. As precise as float sums of offsets within a block.
    TlsSums sums(std::size_t first, std::size_t end) const { return tls(first, end, row(end) - row(first)); }
    /// The same added up in double, point by point.
    TlsSums exactSums(std::size_t first, std::size_t end) const {
        return tls(first, end, exactRow(first, end));
    }
    /// The same from the difference of rows.
    TlsSums tls(std::size_t first, std::size_t end, const SumRow &s) const {
        return TlsSums::fromPlain(static_cast<double>(end - first), s.x, s.y, s.xx, s.xy, s.yy, origin_);
    }

    /// Whether points first .. end - 1 lie within the root of `variance` of their line; two always do.
    bool fitWithin(std::size_t first, std::size_t end, double variance) const {
        return fits(first, row(first), end, row(end), variance);
    }
    /// The same with the rows of both ends.
    bool fits(std::size_t first, const SumRow &before, std::size_t end, const SumRow &all,
              double variance) const {
        if (end <= first + 2)
            return true;
        const double n = static_cast<double>(end - first);
        const ThresholdTest test(n, all - before, variance, stride_ == 1 ? 0 : relativeError,
                                 localError(first, end));
        return test.isUnclear() ? ThresholdTest(n, exactRow(first, end), variance, 0, 0).fits() : test.fits();
    }
    /// What the moments of an interval may be off because of points being local to their blocks; m^2.
    double localError(std::size_t first, std::size_t end) const {
        return stride_ == 1
                   ? 0
                   : 37 * relativeError * (scatter_[(end + block - 1) / block] - scatter_[first / block]);
    }
    /// A bound of how far the moments of sums(first, end) may be off; m^2.
    double rounding(std::size_t first, std::size_t end) const {
        const TlsSums s = sums(first, end);
        return relativeError * (s.xx + s.yy) + localError(first, end);
    }

private:
    SumRow exactRow(std::size_t first, std::size_t end) const {
        SumRow row{};
        for (std::size_t i = first; i < end; ++i)
            addTo(row, i);
        return row;
    }
    void sumPoints() {
        std::size_t i = 0;
#if defined(VECTORLIB_SIMD_AVX2)
        if (level == simd::Level::Avx2)
            i = sumPointsAvx2();
        else
#endif
        {
            SumRow four[4];
            for (; i + 4 <= points_.size(); i += 4) {
                for (std::size_t k = 0; k < 4; ++k) {
                    four[k] = SumRow{};
                    addTo(four[k], i + k);
                }
                setRunning(static_cast<std::ptrdiff_t>(i), four);
            }
        }
        for (SumRow row = table_.row(static_cast<std::ptrdiff_t>(i)); i < points_.size(); ++i) {
            addTo(row, i);
            table_.set(static_cast<std::ptrdiff_t>(i) + 1, row);
        }
    }
    // Four rows behind a row, from the sums between them, in the order in which registers add them.
    void setRunning(std::ptrdiff_t before, const SumRow *sums) {
        const SumRow row = table_.row(before), pair = sums[1] + sums[0];
        table_.set(before + 1, sums[0] + row);
        table_.set(before + 2, pair + row);
        table_.set(before + 3, ((sums[2] + sums[1]) + sums[0]) + row);
        table_.set(before + 4, ((sums[3] + sums[2]) + pair) + row);
    }
    void sumBlocks(std::size_t blocks) {
        local_.resize(blocks + 3);
        scatter_.resize(blocks + 4);
        scatter_[0] = 0;
        fillLastBlock();
        std::fill_n(local_.begin() + static_cast<std::ptrdiff_t>(blocks), 3, simd::BlockSum{});
#if defined(VECTORLIB_SIMD_AVX2)
        if (level == simd::Level::Avx2)
            return sumBlocksAvx2(blocks);
#endif
        for (std::size_t b = 0; b < blocks; ++b)
            local_[b] = simd::sumBlock(&points(b)->x, level);
        for (std::size_t b = 0; b < blocks; b += 4)
            sumFourBlocks(b);
    }
    // A copy of the points after the last full block, filled up with points that add nothing: its middle,
    // which is one of them where they do not reach it.
    void fillLastBlock() {
        const std::size_t count = points_.size() % block;
        const Point *from = points_.end() - count;
        const Point middle = count == 0 ? points_.back() : from[count > block / 2 ? block / 2 : count / 2];
        std::fill(std::copy(from, points_.end(), lastBlock_), lastBlock_ + block, middle);
    }
    double pointsIn(std::size_t b) const {
        const std::size_t full = points_.size() / block;
        return b < full ? block : b == full ? static_cast<double>(points_.size() % block) : 0;
    }
    // Rows b + 1 .. b + 4, from row b.
    void sumFourBlocks(std::size_t b) {
        SumRow rows[4];
        for (std::size_t i = 0; i < 4; ++i) {
            const simd::BlockSum &s = local_[b + i];
            const Vector2D<double> o = Vector2D<double>(points(b + i)[block / 2]) - origin_;
            const double n = pointsIn(b + i), x = s.x, y = s.y, mx = x + n * o.x, my = y + n * o.y;
            const double xy = (s.xy[0] + s.xy[1]) + (s.xy[2] + s.xy[3]);
            rows[i] = {mx, my, s.xx + o.x * (x + mx), s.yy + o.y * (y + my), (xy + o.x * my) + o.y * x};
            scatter_[b + i + 1] = scatter_[b + i] + (double(s.xx) + double(s.yy));
        }
        setRunning(static_cast<std::ptrdiff_t>(b), rows);
    }
#if defined(VECTORLIB_SIMD_AVX2)
    // The rows of all points but the last three at most; returns how many.
    VECTORLIB_AVX2 std::size_t sumPointsAvx2() {
        const __m256d ox = _mm256_set1_pd(origin_.x), oy = _mm256_set1_pd(origin_.y);
        const std::size_t count = points_.size() / 4 * 4;
        double *const columns[5] = {table_.x() + 1, table_.y() + 1, table_.xx() + 1, table_.yy() + 1,
                                    table_.xy() + 1};
        __m256d sums[5] = {};
        const float *p = &points_.begin()->x;
        for (std::size_t i = 0; i < count; i += 4, p += 8) {
            const __m128 a = _mm_loadu_ps(p), b = _mm_loadu_ps(p + 4);
            const __m256d x = _mm256_cvtps_pd(_mm_shuffle_ps(a, b, 0x88)) - ox;
            const __m256d y = _mm256_cvtps_pd(_mm_shuffle_ps(a, b, 0xdd)) - oy;
            const __m256d terms[5] = {x, y, x * x, y * y, x * y};
            for (int q = 0; q < 5; ++q) {
                sums[q] = simd::runningAvx2(terms[q], _mm256_permute4x64_pd(sums[q], 0xff));
                _mm256_storeu_pd(columns[q] + i, sums[q]);
            }
        }
        return count;
    }
    // In three steps, so that the processor always finds work that does not wait for other work.
    VECTORLIB_AVX2 void sumBlocksAvx2(std::size_t blocks) {
        const std::size_t full = points_.size() / block;
        for (std::size_t b = 0; b < full; ++b)
            simd::sumBlockAvx2(&points_[b * block].x, local_[b]);
        if (full < blocks)
            simd::sumBlockAvx2(&lastBlock_[0].x, local_[full]);
        double *const columns[6] = {table_.x(),  table_.y(),  table_.xx(),
                                    table_.yy(), table_.xy(), scatter_.data()};
        std::size_t b = 0;
        for (; b + 4 <= full; b += 4)
            moveFourBlocksAvx2<true>(b, columns);
        if (b < blocks)
            moveFourBlocksAvx2<false>(b, columns);
        __m256d sums[6] = {};
        for (b = 1; b <= blocks; b += 4)
            for (int q = 0; q < 6; ++q) {
                sums[q] =
                    simd::runningAvx2(_mm256_loadu_pd(columns[q] + b), _mm256_permute4x64_pd(sums[q], 0xff));
                _mm256_storeu_pd(columns[q] + b, sums[q]);
            }
    }
    // Puts the sums of four blocks, moved to the origin, where their running sums will be.
    template <bool areFull>
    VECTORLIB_AVX2 VECTORLIB_INLINE void moveFourBlocksAvx2(std::size_t b, double *const *columns) const {
        const Point *p[4];
        for (std::size_t i = 0; i < 4; ++i)
            p[i] = (areFull ? points_.begin() + (b + i) * block : points(b + i)) + block / 2;
        const __m128 i = simd::loadTwoAvx2(&p[0]->x, &p[1]->x), j = simd::loadTwoAvx2(&p[2]->x, &p[3]->x);
        const __m256d ox = _mm256_cvtps_pd(_mm_shuffle_ps(i, j, 0x88)) - _mm256_set1_pd(origin_.x);
        const __m256d oy = _mm256_cvtps_pd(_mm_shuffle_ps(i, j, 0xdd)) - _mm256_set1_pd(origin_.y);
        const __m256d n =
            areFull ? _mm256_set1_pd(block)
                    : _mm256_setr_pd(pointsIn(b), pointsIn(b + 1), pointsIn(b + 2), pointsIn(b + 3));
        const simd::FourBlockSums s = simd::loadFourAvx2(&local_[b]);
        const __m256d mx = s.x + n * ox, my = s.y + n * oy;
        const __m256d values[6] = {
            mx, my, s.xx + ox * (s.x + mx), s.yy + oy * (s.y + my), (s.xy + ox * my) + oy * s.x, s.xx + s.yy};
        for (int q = 0; q < 6; ++q)
            _mm256_storeu_pd(columns[q] + b + 1, values[q]);
    }
#endif

    PointSpan<float> points_;
    Vector2D<double> origin_;
    SumTable table_;
    std::vector<simd::BlockSum> local_; // of each block
    std::vector<double> scatter_;       // before each block: squares of offsets from the blocks' middles; m^2
    std::size_t stride_ = 1;
    std::ptrdiff_t last_ = 0; // the number of the last row
    Point lastBlock_[block];
};

} // namespace vectorlib
