#pragma once

#include "vectorlib/segmentation/Nearness.h"

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

/// All bits of those of eight ranges that are near: within their thresholds, and not too many rays away.
VECTORLIB_AVX2 inline __m256 nearLanes(__m256 ranges, __m256 differences, __m256i between, int reach,
                                       NearThreshold<float> t) {
    const __m256 scaled = _mm256_mul_ps(_mm256_set1_ps(t.scale), ranges);
    const __m256 limit =
        _mm256_min_ps(_mm256_max_ps(scaled, _mm256_set1_ps(t.least)), _mm256_set1_ps(t.most));
    const __m256 distances = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), differences);
    const __m256i far = _mm256_cmpgt_epi32(between, _mm256_set1_epi32(reach));
    return _mm256_andnot_ps(_mm256_castsi256_ps(far), _mm256_cmp_ps(distances, limit, _CMP_LE_OQ));
}

/// PolarNearness::gap() of four.
VECTORLIB_AVX2 inline __m256d gaps(__m128 difference, __m128 range, __m128i between, __m256d step) {
    const __m256d dr = _mm256_cvtps_pd(difference);
    const __m256d arc =
        _mm256_mul_pd(_mm256_cvtps_pd(range), _mm256_mul_pd(_mm256_cvtepi32_pd(between), step));
    return _mm256_add_pd(_mm256_mul_pd(dr, dr), _mm256_mul_pd(arc, arc));
}

VECTORLIB_AVX2 inline double largest(__m256d v) {
    const __m128d m = _mm_max_pd(_mm256_castpd256_pd128(v), _mm256_extractf128_pd(v, 1));
    return _mm_cvtsd_f64(_mm_max_sd(m, _mm_unpackhi_pd(m, m)));
}

/// Compares ranges 1 .. 8 * eights with their predecessors.
VECTORLIB_AVX2 inline void nearPredecessors(const PolarNearness &n, std::size_t eights, NearWord *words) {
    const float *ranges = n.ranges;
    const int *rays = n.rays;
    const __m256d step = _mm256_set1_pd(n.step);
    for (; eights > 0; ++words) {
        const std::size_t here = std::min<std::size_t>(eights, 8);
        std::uint64_t near = 0;
        __m256d widest = _mm256_setzero_pd();
        for (std::size_t e = 0; e < here; ++e, ranges += 8, rays += 8) {
            const __m256 range = _mm256_loadu_ps(ranges + 1);
            const __m256 difference = _mm256_sub_ps(range, _mm256_loadu_ps(ranges));
            const __m256i between = raysBetween(loadEight(rays + 1), loadEight(rays), n.turn);
            const __m256 is = nearLanes(range, difference, between, n.reach, n.threshold);
            near |= static_cast<std::uint64_t>(_mm256_movemask_ps(is)) << (8 * e);
            const __m256 dr = _mm256_and_ps(difference, is); // no gap where not near
            const __m256i apart = _mm256_and_si256(between, _mm256_castps_si256(is));
            const __m256d low = gaps(_mm256_castps256_ps128(dr), _mm256_castps256_ps128(range),
                                     _mm256_castsi256_si128(apart), step);
            const __m256d high = gaps(_mm256_extractf128_ps(dr, 1), _mm256_extractf128_ps(range, 1),
                                      _mm256_extracti128_si256(apart, 1), step);
            widest = _mm256_max_pd(widest, _mm256_max_pd(low, high));
        }
        *words = {near, largest(widest)};
        eights -= here;
    }
}

/// Whether one of the ranges first .. end - 1 is near range `other`, with the threshold `t`. There are at
/// least eight ranges; some beyond first .. end - 1 are read.
VECTORLIB_AVX2 inline bool anyNear(const PolarNearness &n, std::size_t first, std::size_t end,
                                   std::size_t other, NearThreshold<float> t) {
    const __m256 range = _mm256_set1_ps(n.ranges[other]);
    const __m256i ray = _mm256_set1_epi32(n.rays[other]);
    for (; first < end; first += 8) {
        const std::size_t start = std::min(first, n.count - 8);
        const __m256 r = _mm256_loadu_ps(n.ranges + start);
        const __m256i between = raysBetween(loadEight(n.rays + start), ray, n.turn);
        const __m256 is = nearLanes(r, _mm256_sub_ps(r, range), between, n.reach, t);
        const unsigned wanted = (1u << std::min<std::size_t>(end - start, 8)) - (1u << (first - start));
        if (static_cast<unsigned>(_mm256_movemask_ps(is)) & wanted)
            return true;
    }
    return false;
}
#endif

} // namespace vectorlib::simd
