#pragma once

#include "vectorlib/segmentation/CartesianNearSimd.h"

/// The comparisons of PolarNearness, eight at a time, with the same result.
namespace vectorlib::simd {

#if defined(VECTORLIB_SIMD_AVX2)
VECTORLIB_AVX2 inline __m256i loadEight(const int *p) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i *>(p));
}

/// Rays between each of eight and another, the shorter way round.
VECTORLIB_AVX2 inline __m256i raysBetween(__m256i a, __m256i b, int turn) {
    const __m256i ahead = _mm256_abs_epi32(_mm256_sub_epi32(a, b));
    return _mm256_min_epi32(ahead, _mm256_sub_epi32(_mm256_set1_epi32(turn), ahead));
}

/// All bits of those of eight ranges that differ by no more than their limit, and are not too many rays away.
VECTORLIB_AVX2 inline __m256 nearLanes(__m256 differences, __m256 limits, __m256i between, int reach) {
    const __m256 distances = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), differences);
    const __m256i far = _mm256_cmpgt_epi32(between, _mm256_set1_epi32(reach));
    return _mm256_andnot_ps(_mm256_castsi256_ps(far), _mm256_cmp_ps(distances, limits, _CMP_LE_OQ));
}

/// Compares ranges 1 .. 8 * eights with their predecessors. The widest gaps are computed in float and rounded
/// up far enough.
VECTORLIB_AVX2 inline void nearPredecessors(const PolarNearness &n, std::size_t eights, NearWord *words) {
    const float *ranges = n.ranges;
    const int *rays = n.rays;
    const __m256 step = _mm256_set1_ps(static_cast<float>(n.step));
    for (; eights > 0; ++words) {
        const std::size_t here = std::min<std::size_t>(eights, 8);
        std::uint64_t near = 0;
        __m256 widest = _mm256_setzero_ps();
        for (std::size_t e = 0; e < here; ++e, ranges += 8, rays += 8) {
            const __m256 range = _mm256_loadu_ps(ranges + 1);
            const __m256 dr = _mm256_sub_ps(range, _mm256_loadu_ps(ranges));
            const __m256i between = raysBetween(loadEight(rays + 1), loadEight(rays), n.turn);
            const __m256 is = nearLanes(dr, limitsOf(range, n.threshold), between, n.reach);
            near |= static_cast<std::uint64_t>(_mm256_movemask_ps(is)) << (8 * e);
            const __m256 arc = _mm256_mul_ps(range, _mm256_mul_ps(_mm256_cvtepi32_ps(between), step));
            const __m256 gap = _mm256_add_ps(_mm256_mul_ps(dr, dr), _mm256_mul_ps(arc, arc));
            widest = _mm256_max_ps(widest, _mm256_and_ps(gap, is));
        }
        const double most = static_cast<double>(largest(widest));
        *words = {near, most * (1 + 1e-5) + 1e-30};
        eights -= here;
    }
}

/// Which of the ranges first .. first + 7 and range `other` are near; `later`: that is the later one.
VECTORLIB_AVX2 inline unsigned nearBits(const PolarNearness &n, std::size_t first, std::size_t other,
                                        bool later) {
    const __m256 ranges = _mm256_loadu_ps(n.ranges + first);
    const __m256 dr = _mm256_sub_ps(ranges, _mm256_set1_ps(n.ranges[other]));
    const __m256 limits = later ? _mm256_set1_ps(n.limit(other)) : limitsOf(ranges, n.threshold);
    const __m256i between = raysBetween(loadEight(n.rays + first), _mm256_set1_epi32(n.rays[other]), n.turn);
    return static_cast<unsigned>(_mm256_movemask_ps(nearLanes(dr, limits, between, n.reach)));
}
#endif

} // namespace vectorlib::simd
