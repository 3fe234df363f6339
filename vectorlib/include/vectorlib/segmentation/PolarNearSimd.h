#pragma once

#include "vectorlib/segmentation/CartesianNearSimd.h"

/// The comparisons of PolarNearness, eight at a time, with the same result.
namespace vectorlib::simd {

/// More than any rounding of a gap in float, or the loss of a denormal, can have taken away.
inline double roundedUp(float gap) {
    return static_cast<double>(gap) * (1 + 1e-5) + 1e-30;
}

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

/// Compares ranges 1 .. 8 * eights with their predecessors. The widest gaps are computed in float.
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
        *words = {near, roundedUp(largest(widest))};
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
#elif defined(VECTORLIB_SIMD_NEON)
/// Rays between each of four and another, the shorter way round.
VECTORLIB_NEON inline int32x4_t raysBetween(int32x4_t a, int32x4_t b, int turn) {
    const int32x4_t ahead = vabsq_s32(vsubq_s32(a, b));
    return vminq_s32(ahead, vsubq_s32(vdupq_n_s32(turn), ahead));
}

/// All bits of those of four ranges that differ by no more than their limit, and are not too many rays away.
VECTORLIB_NEON inline uint32x4_t nearLanes(float32x4_t differences, float32x4_t limits, int32x4_t between,
                                           int reach) {
    return vandq_u32(within(differences, limits), vcleq_s32(between, vdupq_n_s32(reach)));
}

/// Compares ranges 1 .. 8 * eights with their predecessors. The widest gaps are computed in float.
VECTORLIB_NEON inline void nearPredecessors(const PolarNearness &n, std::size_t eights, NearWord *words) {
    const float *ranges = n.ranges;
    const int *rays = n.rays;
    const float32x4_t step = vdupq_n_f32(static_cast<float>(n.step));
    for (; eights > 0; ++words) {
        const std::size_t here = std::min<std::size_t>(eights, 8);
        std::uint64_t near = 0;
        float32x4_t widest = vdupq_n_f32(0);
        for (std::size_t e = 0; e < here; ++e) {
            uint32x4_t is[2];
            for (int half = 0; half < 2; ++half, ranges += 4, rays += 4) {
                const float32x4_t range = vld1q_f32(ranges + 1), dr = vsubq_f32(range, vld1q_f32(ranges));
                const int32x4_t between = raysBetween(vld1q_s32(rays + 1), vld1q_s32(rays), n.turn);
                is[half] = nearLanes(dr, limitsOf(range, n.threshold), between, n.reach);
                const float32x4_t arc = vmulq_f32(range, vmulq_f32(vcvtq_f32_s32(between), step));
                const float32x4_t gap = vaddq_f32(vmulq_f32(dr, dr), vmulq_f32(arc, arc));
                widest = vmaxq_f32(widest, onlyWhere(is[half], gap));
            }
            near |= bitsOf(is[0], is[1]) << (8 * e);
        }
        *words = {near, roundedUp(largest(widest))};
        eights -= here;
    }
}

/// Which of the ranges first .. first + 7 and range `other` are near; `later`: that is the later one.
VECTORLIB_NEON inline unsigned nearBits(const PolarNearness &n, std::size_t first, std::size_t other,
                                        bool later) {
    uint32x4_t is[2];
    for (std::size_t half = 0; half < 2; ++half) {
        const float32x4_t ranges = vld1q_f32(n.ranges + first + 4 * half);
        const float32x4_t limits = later ? vdupq_n_f32(n.limit(other)) : limitsOf(ranges, n.threshold);
        const int32x4_t between =
            raysBetween(vld1q_s32(n.rays + first + 4 * half), vdupq_n_s32(n.rays[other]), n.turn);
        is[half] = nearLanes(vsubq_f32(ranges, vdupq_n_f32(n.ranges[other])), limits, between, n.reach);
    }
    return static_cast<unsigned>(bitsOf(is[0], is[1]));
}
#endif

} // namespace vectorlib::simd
