#pragma once

#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/simd/SumBlocksNeon.h"
#include "vectorlib/vectorization/SumTable.h"

#include <algorithm>
#include <array>
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

    std::size_t smallCluster = 512; ///< points up to which every point has a row

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
        // Whoever reads eight rows at a time finds the last one again behind it.
        const SumRow all = table_.row(last_);
        for (std::ptrdiff_t i = 1; i <= SumTable::margin; ++i)
            table_.set(last_ + i, all);
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
        return b < copied_ ? points_.begin() + b * block : lastBlocks_ + (b - copied_) * block;
    }

    /// The sums before point i.
    SumRow row(std::size_t i) const {
        SumRow row = table_.row(static_cast<std::ptrdiff_t>(i / stride_));
        for (std::size_t k = i / stride_ * stride_; k < i; ++k)
            addTo(row, k);
        return row;
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
        return stride_ == 1 ? 0 : error_[(end + block - 1) / block] - error_[first / block];
    }
    /// A bound of how far the moments of sums(first, end) may be off; m^2.
    double rounding(std::size_t first, std::size_t end) const {
        const TlsSums s = sums(first, end);
        return relativeError * (s.xx + s.yy) + localError(first, end);
    }

private:
    using Counts = std::array<double, 4>; // points that count in each of four blocks

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
        error_.resize(blocks + 4);
        error_[0] = 0;
        copied_ = points_.size() / (4 * block) * 4;
        const Counts full{block, block, block, block}, last = copied_ < blocks ? copyLastBlocks() : full;
#if defined(VECTORLIB_SIMD_AVX2)
        if (level == simd::Level::Avx2)
            return sumBlocksAvx2(blocks, last);
#endif
        for (std::size_t b = 0; b < blocks; b += 4)
            sumFourBlocks(static_cast<std::ptrdiff_t>(b), b < copied_ ? full : last);
    }
    // The points after the last four full blocks, filled up with points that add nothing: each block's
    // middle. Returns how many count in each block.
    Counts copyLastBlocks() {
        Counts counts{};
        const Point *from = points_.begin() + copied_ * block;
        for (std::size_t b = 0; b < 4; ++b) {
            Point *const to = lastBlocks_ + b * block;
            const std::size_t count = std::min<std::size_t>(points_.end() - from, block);
            const Point middle = count == 0 ? points_.back() : from[std::min(count / 2, block / 2)];
            std::fill(std::copy(from, from + count, to), to + block, middle);
            counts[b] = static_cast<double>(count);
            from += count;
        }
        return counts;
    }
    // Rows first + 1 .. first + 4, from row `first`.
    void sumFourBlocks(std::ptrdiff_t first, const Counts &counts) {
        const std::size_t at = static_cast<std::size_t>(first);
        const simd::FourSums s = simd::sumFourBlocks(&points(at)->x, level);
        SumRow rows[4];
        for (std::size_t b = 0; b < 4; ++b) {
            const Vector2D<double> o = Vector2D<double>(points(at + b)[block / 2]) - origin_;
            const double nx = counts[b] * o.x, ny = counts[b] * o.y;
            rows[b] = {s.x[b] + nx, s.y[b] + ny, s.xx[b] + o.x * (2 * s.x[b] + nx),
                       s.yy[b] + o.y * (2 * s.y[b] + ny), (s.xy[b] + o.x * (s.y[b] + ny)) + o.y * s.x[b]};
            error_[at + b + 1] = error_[at + b] + 37 * relativeError * (s.xx[b] + s.yy[b]);
        }
        setRunning(first, rows);
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
    // Puts the running sums of four values behind column[0], the sum before them.
    VECTORLIB_AVX2 VECTORLIB_INLINE static void putRunning(double *column, __m256d v) {
        _mm256_storeu_pd(column + 1, simd::runningAvx2(v, _mm256_broadcast_sd(column)));
    }
    VECTORLIB_AVX2 void sumBlocksAvx2(std::size_t blocks, const Counts &last) {
        double *const columns[5] = {table_.x(), table_.y(), table_.xx(), table_.yy(), table_.xy()};
        double *const error = error_.data();
        const __m256d originX = _mm256_set1_pd(origin_.x), originY = _mm256_set1_pd(origin_.y);
        constexpr std::size_t stride = 2 * block;
        for (std::size_t b = 0; b < blocks; b += 4) {
            const bool isFull = b < copied_;
            const float *const p = &points(b)->x;
            const double *const m = reinterpret_cast<const double *>(p + block); // a point in a double
            const __m256d n = isFull ? _mm256_set1_pd(block) : _mm256_loadu_pd(last.data());
            __m256d x, y, xx, yy, xy;
            simd::sumFourBlocksAvx2(p, x, y, xx, yy, xy);
            const __m128 i = _mm_castpd_ps(_mm_loadh_pd(_mm_load_sd(m), m + stride / 2));
            const __m128 j = _mm_castpd_ps(_mm_loadh_pd(_mm_load_sd(m + stride), m + 3 * stride / 2));
            const __m256d ox = _mm256_cvtps_pd(_mm_shuffle_ps(i, j, 0x88)) - originX;
            const __m256d oy = _mm256_cvtps_pd(_mm_shuffle_ps(i, j, 0xdd)) - originY;
            const __m256d nx = n * ox, ny = n * oy;
            putRunning(columns[0] + b, x + nx);
            putRunning(columns[1] + b, y + ny);
            putRunning(columns[2] + b, xx + ox * (x + x + nx));
            putRunning(columns[3] + b, yy + oy * (y + y + ny));
            putRunning(columns[4] + b, (xy + ox * (y + ny)) + oy * x);
            putRunning(error + b, _mm256_set1_pd(37 * relativeError) * (xx + yy));
        }
    }
#endif

    PointSpan<float> points_;
    Vector2D<double> origin_;
    SumTable table_;
    std::vector<double> error_; // of each row of blocks: how far the moments may be off; m^2
    std::size_t stride_ = 1;
    std::ptrdiff_t last_ = 0; // the number of the last row
    std::size_t copied_ = 0;  // blocks from here on are in lastBlocks_
    Point lastBlocks_[4 * block];
};

} // namespace vectorlib
