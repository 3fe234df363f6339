#pragma once

#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/simd/Simd.h"
#include "vectorlib/vectorization/SumRow.h"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace vectorlib {

/// The sums of any interval of points, like PrefixSums, but kept at the borders of blocks of points only:
/// offsets from the middle of each block are added up in float by SIMD, the blocks' sums in double. Points of
/// another type than float are added up in double. An interval that begins or ends inside a block reads the
/// points of that block again, in double. Refers to the points given: they must outlive it.
///
/// fitWithin() answers as exact sums would: float sums carry a bound of their rounding, and an interval whose
/// variance is nearer to the threshold than that (a few parts in a thousand) is added up anew in double.
template <typename Scalar = float>
class BlockSums {
public:
    static constexpr std::size_t block = 32; ///< points

    simd::Level level = simd::bestLevel(); ///< the instruction set to use

    void assign(PointSpan<Scalar> points) {
        points_ = points;
        const std::size_t count = points.size(), full = count / block;
        borders_.resize(full + 2);
        borders_[0] = Border();
        if (count == 0)
            return;
        origin_ = Vector2D<double>(points.front());
        sumBlocks(full);
        borders_[full + 1] = borders_[full];
        for (std::size_t i = full * block; i < count; ++i)
            addTo(borders_[full + 1].row, i);
    }

    std::size_t size() const { return points_.size(); }
    /// How many blocks, the last of them perhaps not full.
    std::size_t blocks() const { return (points_.size() + block - 1) / block; }
    /// Where block b begins; where the last one ends for b = blocks().
    std::size_t border(std::size_t b) const { return std::min(b * block, points_.size()); }

    /// The sums of points first .. end - 1; end > first. As precise as float sums of offsets within a block.
    TlsSums sums(std::size_t first, std::size_t end) const { return between(at(first), at(end)); }
    /// The same added up in double, point by point.
    TlsSums exactSums(std::size_t first, std::size_t end) const {
        return toTls(static_cast<double>(end - first), exactRow(first, end));
    }
    /// Whether points first .. end - 1 lie within the root of `variance` of their line.
    bool fitWithin(std::size_t first, std::size_t end, double variance) const {
        return fit(at(first), at(end), variance);
    }

    /// A bound of how far the moments of sums(first, end) may be off; m^2.
    double rounding(std::size_t first, std::size_t end) const {
        const TlsSums s = sums(first, end);
        return relativeError * (s.xx + s.yy) + (at(end).error - at(first).error);
    }

    /// The sums before one point, and how far the float sums among them may be off.
    struct Position {
        std::size_t index = 0;
        SumRow row{};
        double error = 0;
    };
    /// The sums before block b, or before the end for b = blocks(): no point is read.
    Position atBorder(std::size_t b) const { return {border(b), borders_[b].row, borders_[b].error}; }
    Position at(std::size_t i) const {
        const std::size_t b = i / block;
        Position p{i, borders_[b].row, borders_[b].error};
        for (std::size_t k = b * block; k < i; ++k)
            addTo(p.row, k);
        return p;
    }
    /// Whether the points between two positions lie within the root of `variance` of their line.
    bool fit(const Position &first, const Position &end, double variance) const {
        return fit(first, end.index, end.row - first.row, end.error - first.error, variance);
    }
    /// The same for the interval up to the beginning of block b.
    bool fitBorder(const Position &first, std::size_t b, double variance) const {
        const Border &end = borders_[b];
        return fit(first, border(b), end.row - first.row, end.error - first.error, variance);
    }
    /// The last end inside block b of an interval that fits, where the beginning of the block (or `first`, if
    /// that lies inside) fits and its end does not: eight points at a time, then by halving.
    Position extend(const Position &first, std::size_t b, double variance) const {
        constexpr std::size_t step = 8;
        const bool inside = border(b) <= first.index;
        const double error = inside ? 0 : borders_[b].error - first.error;
        std::size_t begin = inside ? first.index : border(b);
        SumRow rows[step + 1];
        rows[0] = inside ? SumRow{} : borders_[b].row - first.row;
        for (const std::size_t end = border(b + 1); begin < end;) {
            const std::size_t count = std::min(step, end - begin);
            for (std::size_t i = 0; i < count; ++i) {
                rows[i + 1] = rows[i];
                addTo(rows[i + 1], begin + i);
            }
            if (fit(first, begin + count, rows[count], error, variance)) {
                rows[0] = rows[count];
                begin += count;
                continue;
            }
            std::size_t good = 0;
            for (std::size_t bad = count; bad - good > 1;) {
                const std::size_t middle = (good + bad) / 2;
                (fit(first, begin + middle, rows[middle], error, variance) ? good : bad) = middle;
            }
            return {begin + good, first.row + rows[good], borders_[b].error};
        }
        return {begin, first.row + rows[0], borders_[b].error};
    }
    TlsSums between(const Position &first, const Position &end) const {
        return toTls(static_cast<double>(end.index - first.index), end.row - first.row);
    }

private:
    // The sums before a block. `error` grows with every block summed in float.
    struct Border {
        SumRow row{};
        double error = 0;
    };
    // The float sums of a block carry at most 10 roundings of 2^-24 each. By Cauchy's inequality the moments
    // of an interval with scatter T, and with local scatter L about the middles of its blocks, are then off
    // by at most 10 * 2^-24 (L + 2 sqrt(2 (T + L) L)), and 2 sqrt(2 (T + L) L) <= (T + L) / 4 + 8 L. Twice
    // that for the eigenvalue: 3e-7 (T + 37 L).
    static constexpr double relativeError = 3e-7;

    bool fit(const Position &first, std::size_t end, const SumRow &sum, double error, double variance) const {
        const ThresholdTest test(static_cast<double>(static_cast<std::ptrdiff_t>(end - first.index)), sum,
                                 variance, relativeError, error);
        return test.isUnclear() ? fitExactly(first.index, end, variance) : test.fits();
    }
    // Kept out of the loops, which would lose registers to it.
    VECTORLIB_COLD bool fitExactly(std::size_t first, std::size_t end, double variance) const {
        const double n = static_cast<double>(end - first);
        return n <= 2 || ThresholdTest(n, exactRow(first, end), variance, 0, 0).fits();
    }
    void addTo(SumRow &row, std::size_t i) const {
        row.add(static_cast<double>(points_[i].x) - origin_.x, static_cast<double>(points_[i].y) - origin_.y);
    }
    TlsSums toTls(double n, const SumRow &s) const {
        return TlsSums::fromPlain(n, s.x, s.y, s.xx, s.xy, s.yy, origin_);
    }
    SumRow exactRow(std::size_t first, std::size_t end) const {
        SumRow row{};
        for (std::size_t i = first; i < end; ++i)
            addTo(row, i);
        return row;
    }
    void sumBlocks(std::size_t full) {
        if constexpr (std::is_same_v<Scalar, float>) {
#if defined(VECTORLIB_SIMD_AVX2)
            if (level == simd::Level::Avx2)
                return sumBlocksAvx2(full);
#endif
            const float *p = &points_.begin()->x;
            Border sum;
            for (std::size_t b = 0; b < full; ++b) {
                append(sum, b, simd::sumScalar(p + 2 * block * b, block / 8, middle(b).x, middle(b).y));
                borders_[b + 1] = sum;
            }
        } else {
            for (std::size_t b = 0; b < full; ++b) {
                borders_[b + 1].error = 0;
                borders_[b + 1].row = borders_[b].row;
                for (std::size_t i = b * block; i < (b + 1) * block; ++i)
                    addTo(borders_[b + 1].row, i);
            }
        }
    }
#if defined(VECTORLIB_SIMD_AVX2)
    VECTORLIB_AVX2 void sumBlocksAvx2(std::size_t full) {
        const float *p = &points_.begin()->x;
        Border sum;
        const __m256d n = _mm256_set1_pd(block), two = _mm256_setr_pd(0, 0, 2, 2), one = _mm256_set1_pd(1);
        const __m256d origin = _mm256_setr_pd(origin_.x, origin_.y, origin_.x, origin_.y);
        __m256d row = _mm256_setzero_pd(); // x, y, xx, yy
        for (std::size_t b = 0; b < full; ++b, p += 2 * block) {
            const simd::Sums s = simd::sumAvx2(p, block / 8, p[block], p[block + 1]);
            const __m128 middle = _mm_castpd_ps(_mm_load1_pd(reinterpret_cast<const double *>(p + block)));
            const __m256d o = _mm256_sub_pd(_mm256_cvtps_pd(middle), origin);
            const __m256d four = _mm256_cvtps_pd(_mm_loadu_ps(&s.x));
            // x + n ox, y + n oy, xx + ox (2 x + n ox), yy + oy (2 y + n oy)
            const __m256d linear = _mm256_mul_pd(two, _mm256_permute2f128_pd(four, four, 0));
            const __m256d inner = _mm256_add_pd(linear, _mm256_mul_pd(n, _mm256_blend_pd(one, o, 0xc)));
            row = _mm256_add_pd(row, _mm256_add_pd(four, _mm256_mul_pd(o, inner)));
            const double ox = _mm256_cvtsd_f64(o), oy = p[block + 1] - origin_.y;
            const double x = s.x, y = s.y;
            sum.row.xy += s.xy + ox * (y + double(block) * oy) + oy * x;
            sum.error += 37 * relativeError * (double(s.xx) + double(s.yy));
            Border &to = borders_[b + 1];
            _mm256_storeu_pd(&to.row.x, row);
            to.row.xy = sum.row.xy;
            to.error = sum.error;
        }
    }
#endif
    const Vector2D<Scalar> &middle(std::size_t b) const {
        return points_[b * block + block / 2];
    }
    // Moves the sums of block b from its middle to the cluster's frame and adds them to those before.
    void append(Border &sum, std::size_t b, const simd::Sums &s) const {
        constexpr double n = block;
        const double ox = middle(b).x - origin_.x, oy = middle(b).y - origin_.y;
        const double x = s.x, y = s.y, xx = s.xx, yy = s.yy, xy = s.xy;
        sum.row.x += x + n * ox;
        sum.row.y += y + n * oy;
        sum.row.xx += xx + ox * (2 * x + n * ox);
        sum.row.xy += xy + ox * (y + n * oy) + oy * x;
        sum.row.yy += yy + oy * (2 * y + n * oy);
        sum.error += 37 * relativeError * (xx + yy);
    }

    PointSpan<Scalar> points_;
    Vector2D<double> origin_;
    std::vector<Border> borders_;
};

} // namespace vectorlib
