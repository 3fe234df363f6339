#pragma once

#include "vectorlib/segmentation/Nearness.h"

/// The comparisons of CartesianNearness<float>, eight at a time, with the same result.
namespace vectorlib::simd {

#if defined(VECTORLIB_SIMD_AVX2)
/// x^2 + y^2 of eight points; in the order 0 1 4 5 2 3 6 7, which unpacking gives.
VECTORLIB_AVX2 inline __m256 squaredNorms(__m256 a, __m256 b) {
    a = _mm256_mul_ps(a, a);
    b = _mm256_mul_ps(b, b);
    return _mm256_add_ps(_mm256_shuffle_ps(a, b, 0x88), _mm256_shuffle_ps(a, b, 0xdd));
}

/// A bit for each of these lanes, in the order of the points.
VECTORLIB_AVX2 inline unsigned bitsOf(__m256 lanes) {
    const __m256d ordered = _mm256_permute4x64_pd(_mm256_castps_pd(lanes), 0xd8);
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castpd_ps(ordered)));
}

VECTORLIB_AVX2 inline float largest(__m256 v) {
    __m128 m = _mm_max_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
    m = _mm_max_ps(m, _mm_movehl_ps(m, m));
    return _mm_cvtss_f32(_mm_max_ss(m, _mm_shuffle_ps(m, m, 1)));
}

/// NearThreshold of eight ranges or of their squares.
VECTORLIB_AVX2 inline __m256 limitsOf(__m256 ranges, const NearThreshold<float> &t) {
    const __m256 scaled = _mm256_mul_ps(_mm256_set1_ps(t.scale), ranges);
    return _mm256_min_ps(_mm256_max_ps(scaled, _mm256_set1_ps(t.least)), _mm256_set1_ps(t.most));
}

/// Compares points 1 .. 8 * eights with their predecessors. Where all eight distances are under the lower
/// bound, as in a dense scan, the ranges are not needed.
VECTORLIB_AVX2 inline void nearPredecessors(const CartesianNearness<float> &n, std::size_t eights,
                                            NearWord *words) {
    const __m256 sure = limitsOf(_mm256_setzero_ps(), n.threshold);
    const float *p = &n.points->x;
    for (; eights > 0; ++words) {
        const std::size_t here = std::min<std::size_t>(eights, 8);
        std::uint64_t near = 0;
        __m256 widest = _mm256_setzero_ps();
        for (std::size_t e = 0; e < here; ++e, p += 16) {
            const __m256 c = _mm256_loadu_ps(p + 2), d = _mm256_loadu_ps(p + 10);
            __m256 gap =
                squaredNorms(_mm256_sub_ps(c, _mm256_loadu_ps(p)), _mm256_sub_ps(d, _mm256_loadu_ps(p + 8)));
            std::uint64_t bits = 0xff;
            if (_mm256_movemask_ps(_mm256_cmp_ps(gap, sure, _CMP_LE_OQ)) != 0xff) {
                const __m256 limits = limitsOf(squaredNorms(c, d), n.threshold);
                const __m256 is = _mm256_cmp_ps(gap, limits, _CMP_LE_OQ);
                bits = bitsOf(is);
                gap = _mm256_and_ps(gap, is);
            }
            near |= bits << (8 * e);
            widest = _mm256_max_ps(widest, gap);
        }
        *words = {near, static_cast<double>(largest(widest))};
        eights -= here;
    }
}

/// Which of the points first .. first + 7 and point `other` are near; `later`: that is the later one.
VECTORLIB_AVX2 inline unsigned nearBits(const CartesianNearness<float> &n, std::size_t first,
                                        std::size_t other, bool later) {
    const float *p = &n.points[first].x;
    const __m256 a = _mm256_loadu_ps(p), b = _mm256_loadu_ps(p + 8);
    const __m256 origin =
        _mm256_unpacklo_ps(_mm256_set1_ps(n.points[other].x), _mm256_set1_ps(n.points[other].y));
    const __m256 gap = squaredNorms(_mm256_sub_ps(a, origin), _mm256_sub_ps(b, origin));
    const __m256 limits = later ? _mm256_set1_ps(n.limit(other)) : limitsOf(squaredNorms(a, b), n.threshold);
    return bitsOf(_mm256_cmp_ps(gap, limits, _CMP_LE_OQ));
}
#endif

} // namespace vectorlib::simd
