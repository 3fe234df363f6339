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
#elif defined(VECTORLIB_SIMD_NEON)
/// A bit for each of eight lanes.
VECTORLIB_NEON inline std::uint64_t bitsOf(uint32x4_t low, uint32x4_t high) {
    const uint8x8_t weights = vcreate_u8(0x8040201008040201);
    const uint8x8_t lanes = vmovn_u16(vcombine_u16(vmovn_u32(low), vmovn_u32(high)));
    return vget_lane_u64(vpaddl_u32(vpaddl_u16(vpaddl_u8(vand_u8(lanes, weights)))), 0);
}

VECTORLIB_NEON inline float largest(float32x4_t v) {
    const float32x2_t two = vpmax_f32(vget_low_f32(v), vget_high_f32(v));
    return vget_lane_f32(vpmax_f32(two, two), 0);
}

/// x^2 + y^2 of four points.
VECTORLIB_NEON inline float32x4_t squaredNorms(float32x4x2_t p) {
    return vaddq_f32(vmulq_f32(p.val[0], p.val[0]), vmulq_f32(p.val[1], p.val[1]));
}

VECTORLIB_NEON inline float32x4x2_t differences(float32x4x2_t a, float32x4x2_t b) {
    return {{vsubq_f32(a.val[0], b.val[0]), vsubq_f32(a.val[1], b.val[1])}};
}

/// NearThreshold of four ranges or of their squares. Where a range is no number the limit is none either, and
/// no distance within it.
VECTORLIB_NEON inline float32x4_t limitsOf(float32x4_t ranges, const NearThreshold<float> &t) {
    const float32x4_t scaled = vmulq_f32(vdupq_n_f32(t.scale), ranges);
    return vminq_f32(vmaxq_f32(scaled, vdupq_n_f32(t.least)), vdupq_n_f32(t.most));
}

/// All bits of the lanes in which a distance or difference is within its limit, which is not negative: of
/// vcleq_f32 GCC 12 makes scalar code for ARMv7.
VECTORLIB_NEON inline uint32x4_t within(float32x4_t distances, float32x4_t limits) {
    return vcaleq_f32(distances, limits);
}

/// The lanes where `is` is set, and 0 elsewhere.
VECTORLIB_NEON inline float32x4_t onlyWhere(uint32x4_t is, float32x4_t v) {
    return vreinterpretq_f32_u32(vandq_u32(is, vreinterpretq_u32_f32(v)));
}

/// Compares points 1 .. 8 * eights with their predecessors. ARMv7 takes denormal numbers for 0.
VECTORLIB_NEON inline void nearPredecessors(const CartesianNearness<float> &n, std::size_t eights,
                                            NearWord *words) {
    const float *p = &n.points->x;
    for (; eights > 0; ++words) {
        const std::size_t here = std::min<std::size_t>(eights, 8);
        std::uint64_t near = 0;
        float32x4_t widest = vdupq_n_f32(0);
        for (std::size_t e = 0; e < here; ++e, p += 16) {
            uint32x4_t is[2];
            for (int half = 0; half < 2; ++half) {
                const float32x4x2_t later = vld2q_f32(p + 8 * half + 2);
                const float32x4_t gap = squaredNorms(differences(later, vld2q_f32(p + 8 * half)));
                is[half] = within(gap, limitsOf(squaredNorms(later), n.threshold));
                widest = vmaxq_f32(widest, onlyWhere(is[half], gap));
            }
            near |= bitsOf(is[0], is[1]) << (8 * e);
        }
        *words = {near, static_cast<double>(largest(widest))};
        eights -= here;
    }
}

/// Which of the points first .. first + 7 and point `other` are near; `later`: that is the later one.
VECTORLIB_NEON inline unsigned nearBits(const CartesianNearness<float> &n, std::size_t first,
                                        std::size_t other, bool later) {
    const float32x4x2_t origin = {{vdupq_n_f32(n.points[other].x), vdupq_n_f32(n.points[other].y)}};
    const float *p = &n.points[first].x;
    uint32x4_t is[2];
    for (int half = 0; half < 2; ++half) {
        const float32x4x2_t four = vld2q_f32(p + 8 * half);
        const float32x4_t limits =
            later ? vdupq_n_f32(n.limit(other)) : limitsOf(squaredNorms(four), n.threshold);
        is[half] = within(squaredNorms(differences(four, origin)), limits);
    }
    return static_cast<unsigned>(bitsOf(is[0], is[1]));
}
#endif

} // namespace vectorlib::simd
