#pragma once

#include "vectorlib/simd/Simd.h"
#include "vectorlib/vectorization/BlockSums.h"
#include "vectorlib/vectorization/PrefixSums.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <vector>

#if defined(VECTORLIB_SIMD_AVX2)

namespace vectorlib {

/// Four rows of four values become their columns.
VECTORLIB_AVX2 VECTORLIB_INLINE void transposeAvx2(__m256d &a, __m256d &b, __m256d &c, __m256d &d) {
    const __m256d e = _mm256_unpacklo_pd(a, b), f = _mm256_unpackhi_pd(a, b);
    const __m256d g = _mm256_unpacklo_pd(c, d), h = _mm256_unpackhi_pd(c, d);
    a = _mm256_permute2f128_pd(e, g, 0x20);
    b = _mm256_permute2f128_pd(f, h, 0x20);
    c = _mm256_permute2f128_pd(e, g, 0x31);
    d = _mm256_permute2f128_pd(f, h, 0x31);
}

// The values of a line lie behind its two indices, in this order: n, mean, xx, xy, yy, a, b, c, sigma, begin,
// end, direction.
static_assert(sizeof(VectorizedLine) == 2 * sizeof(std::size_t) + 16 * sizeof(double));

/// makeLine() for up to four intervals between cuts, in the frame of `origin`, with the same results.
VECTORLIB_AVX2 VECTORLIB_INLINE void makeFourLinesAvx2(PointSpan<float> points, Vector2D<double> origin,
                                                       const Cut *cuts, std::size_t count,
                                                       VectorizedLine *lines) {
    // Where there are less than four, the last one again.
    const Cut *from[4];
    for (std::size_t i = 0; i < 4; ++i)
        from[i] = cuts + std::min(i, count - 1);
    const auto row = [&from](int i) VECTORLIB_AVX2 {
        return _mm256_loadu_pd(&from[i][1].row.x) - _mm256_loadu_pd(&from[i][0].row.x);
    };
    __m256d x = row(0), y = row(1), sxx = row(2), syy = row(3);
    transposeAvx2(x, y, sxx, syy);
    const auto mixed = [&from](int i) { return from[i][1].row.xy - from[i][0].row.xy; };
    const auto number = [&from](int i) {
        return static_cast<double>(static_cast<std::ptrdiff_t>(from[i][1].index - from[i][0].index));
    };
    const auto begin = [&](int i) { return points[from[i]->index]; };
    const auto last = [&](int i) { return points[from[i][1].index - 1]; };
    const __m256d n = _mm256_setr_pd(number(0), number(1), number(2), number(3));
    const __m256d sxy = _mm256_setr_pd(mixed(0), mixed(1), mixed(2), mixed(3));
    const __m256d zero = _mm256_setzero_pd(), sign = _mm256_set1_pd(-0.0), one = _mm256_set1_pd(1);
    // TlsSums::fromPlain()
    const __m256d inverse = one / n, mx = x * inverse, my = y * inverse;
    const __m256d meanX = _mm256_set1_pd(origin.x) + mx, meanY = _mm256_set1_pd(origin.y) + my;
    const __m256d xx = _mm256_max_pd(zero, sxx - x * mx);
    const __m256d yy = _mm256_max_pd(zero, syy - y * my);
    const __m256d xy = sxy - x * my;
    // fitLine()
    const __m256d p = _mm256_xor_pd(xy, sign), q = xx - yy, four = _mm256_set1_pd(4);
    const __m256d root = _mm256_sqrt_pd(four * p * p + q * q);
    const __m256d least = _mm256_max_pd(_mm256_set1_pd(1e-14) * (xx + yy), _mm256_set1_pd(1e-150));
    const __m256d valid = _mm256_and_pd(_mm256_cmp_pd(root, least, _CMP_GT_OQ),
                                        _mm256_cmp_pd(root, _mm256_set1_pd(1e150), _CMP_LT_OQ));
    const __m256d h = _mm256_set1_pd(0.5) * (root + _mm256_andnot_pd(sign, q));
    const __m256d scale = one / _mm256_sqrt_pd(h * root);
    const __m256d large = h * scale, small = _mm256_andnot_pd(sign, p) * scale;
    const __m256d steep = _mm256_cmp_pd(q, zero, _CMP_GT_OQ);
    __m256d a = _mm256_blendv_pd(large, small, steep), b = _mm256_blendv_pd(small, large, steep);
    b = _mm256_xor_pd(b, _mm256_and_pd(_mm256_cmp_pd(p, zero, _CMP_LE_OQ), sign));
    __m256d c = _mm256_xor_pd(a * meanX + b * meanY, sign);
    const __m256d away = _mm256_and_pd(_mm256_cmp_pd(c, zero, _CMP_LT_OQ), sign);
    a = _mm256_xor_pd(a, away);
    b = _mm256_xor_pd(b, away);
    c = _mm256_xor_pd(c, away);
    const __m256d squares = a * a * xx + _mm256_set1_pd(2) * a * b * xy + b * b * yy;
    const __m256d deviation = _mm256_sqrt_pd(_mm256_max_pd(squares / n, zero));
    // The ends: Line2D::project()
    __m256d bx = _mm256_setr_pd(begin(0).x, begin(1).x, begin(2).x, begin(3).x),
            by = _mm256_setr_pd(begin(0).y, begin(1).y, begin(2).y, begin(3).y),
            ex = _mm256_setr_pd(last(0).x, last(1).x, last(2).x, last(3).x),
            ey = _mm256_setr_pd(last(0).y, last(1).y, last(2).y, last(3).y);
    const __m256d db = a * bx + b * by + c, de = a * ex + b * ey + c;
    bx = bx - a * db;
    by = by - b * db;
    ex = ex - a * de;
    ey = ey - b * de;
    __m256d ux = _mm256_xor_pd(b, sign), uy = a;
    const __m256d length = ux * (ex - bx) + uy * (ey - by);
    const __m256d back = _mm256_andnot_pd(_mm256_cmp_pd(length, zero, _CMP_GT_OQ), sign);
    ux = _mm256_xor_pd(ux, back);
    uy = _mm256_xor_pd(uy, back);
    // All that could not be finite is in the line's offset, its deviation or its length.
    const __m256d finite = _mm256_cmp_pd(
        (c - c) + (deviation - deviation) + (length - length) + (xx - xx) + (yy - yy), zero, _CMP_EQ_OQ);
    const __m256d good =
        _mm256_and_pd(_mm256_and_pd(finite, valid), _mm256_cmp_pd(length, zero, _CMP_NEQ_OQ));
    const int usual = _mm256_movemask_pd(good);
    __m256d out[16] = {n, meanX, meanY, xx, xy, yy, a, b, c, deviation, bx, by, ex, ey, ux, uy};
    for (int k = 0; k < 16; k += 4)
        transposeAvx2(out[k], out[k + 1], out[k + 2], out[k + 3]);
    for (std::size_t i = 0; i < count; ++i) {
        VectorizedLine &line = lines[i];
        if (usual >> i & 1) {
            line.first = cuts[i].index;
            line.last = cuts[i + 1].index - 1;
            for (std::size_t k = 0; k < 4; ++k)
                _mm256_storeu_pd(&line.sums.n + 4 * k, out[4 * k + i]);
        } else {
            line = makeLine(points, cuts[i].index, cuts[i + 1].index - 1,
                            sumsBetween(cuts[i], cuts[i + 1], origin));
        }
    }
}

} // namespace vectorlib

#endif

namespace vectorlib {

/// makeLine() for the intervals between cuts, whose rows are in the frame of `origin`.
template <typename Scalar>
void makeLines(PointSpan<Scalar> points, Vector2D<double> origin, const std::vector<Cut> &cuts,
               std::vector<VectorizedLine> &lines) {
    lines.resize(cuts.size() - 1);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const Cut &first = cuts[i], &end = cuts[i + 1];
        lines[i] = makeLine(points, first.index, end.index - 1, sumsBetween(first, end, origin));
    }
}

#if defined(VECTORLIB_SIMD_AVX2)
/// Its twin, four lines at a time.
VECTORLIB_AVX2 inline void makeLinesAvx2(PointSpan<float> points, Vector2D<double> origin,
                                         const std::vector<Cut> &cuts, std::vector<VectorizedLine> &lines) {
    lines.resize(cuts.size() - 1);
    for (std::size_t i = 0; i < lines.size(); i += 4)
        makeFourLinesAvx2(points, origin, &cuts[i], std::min<std::size_t>(lines.size() - i, 4), &lines[i]);
}
#endif

/// The same from sums in double, and from sums in float with the instruction set to use.
template <typename Scalar>
void makeLines(PointSpan<Scalar> points, const PrefixSums &sums, const std::vector<Cut> &cuts, simd::Level,
               std::vector<VectorizedLine> &lines) {
    makeLines(points, sums.origin(), cuts, lines);
}
/// The same from sums in float; lines for which these are not exact enough are made from exact sums.
inline void makeLines(PointSpan<float> points, const BlockSums &sums, const std::vector<Cut> &cuts,
                      [[maybe_unused]] simd::Level level, std::vector<VectorizedLine> &lines) {
#if defined(VECTORLIB_SIMD_AVX2)
    if (level == simd::Level::Avx2)
        makeLinesAvx2(points, sums.origin(), cuts, lines);
    else
#endif
        makeLines(points, sums.origin(), cuts, lines);
    // A point far from the others of its block spoils the float sums of the block: exact ones tell.
    for (VectorizedLine &line : lines) {
        const double error = sums.localError(line.first, line.last + 1);
        if (!(error <= 0.2 * line.sigma * line.sigma * line.sums.n) && error > 1e-12)
            line = makeLine(points, line.first, line.last, sums.exactSums(line.first, line.last + 1));
    }
}

} // namespace vectorlib
