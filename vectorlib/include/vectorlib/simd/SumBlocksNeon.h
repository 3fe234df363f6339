#pragma once

#include "vectorlib/simd/SumBlocks.h"

namespace vectorlib::simd {

#if defined(VECTORLIB_SIMD_NEON)
VECTORLIB_NEON VECTORLIB_INLINE float32x4_t addFourNeon(const float32x4_t *v) {
    return vaddq_f32(vaddq_f32(v[0], v[1]), vaddq_f32(v[2], v[3]));
}
VECTORLIB_NEON VECTORLIB_INLINE float totalNeon(const float32x4_t *v) {
    const float32x4_t four = addFourNeon(v);
    const float32x2_t pairs = vpadd_f32(vget_low_f32(four), vget_high_f32(four));
    return vget_lane_f32(vpadd_f32(pairs, pairs), 0);
}

/// The twin of sumBlock(). Its lanes 0, 2, 4 and 6 are those of x here, the others those of y.
VECTORLIB_NEON inline BlockSum sumBlockNeon(const float *points) {
    const float32x4_t mx = vdupq_n_f32(points[blockPoints]), my = vdupq_n_f32(points[blockPoints + 1]);
    float32x4_t x[4], y[4], xx[4], yy[4], even[4], odd[4];
    for (int i = 0; i < 4; ++i) {
        const float32x4x2_t p = vld2q_f32(points + 16 * i), q = vld2q_f32(points + 16 * i + 8);
        const float32x4_t px = vsubq_f32(p.val[0], mx), py = vsubq_f32(p.val[1], my);
        const float32x4_t qx = vsubq_f32(q.val[0], mx), qy = vsubq_f32(q.val[1], my);
        x[i] = vaddq_f32(px, qx);
        y[i] = vaddq_f32(py, qy);
        xx[i] = vmlaq_f32(vmulq_f32(px, px), qx, qx); // on ARMv7 the product is rounded, too
        yy[i] = vmlaq_f32(vmulq_f32(py, py), qy, qy);
        even[i] = vmulq_f32(px, py);
        odd[i] = vmulq_f32(qx, qy);
    }
    BlockSum sum{totalNeon(x), totalNeon(y), totalNeon(xx), totalNeon(yy), {}};
    const float32x4_t c = addFourNeon(even), d = addFourNeon(odd);
    vst1_f32(sum.xy, vadd_f32(vget_low_f32(c), vget_high_f32(c)));
    vst1_f32(sum.xy + 2, vadd_f32(vget_low_f32(d), vget_high_f32(d)));
    return sum;
}

/// The twin of sumFours(). Eight points at a time: x and y of the even ones, x and y of the odd ones.
VECTORLIB_NEON inline SumsOfFours sumFoursNeon(const float *points) {
    SumsOfFours sums;
    const float32x4_t mx = vdupq_n_f32(points[blockPoints]), my = vdupq_n_f32(points[blockPoints + 1]);
    const auto store = [](float *to, float32x4_t pairs) VECTORLIB_NEON {
        vst1_f32(to, vpadd_f32(vget_low_f32(pairs), vget_high_f32(pairs)));
    };
    for (int i = 0; i < 8; i += 2) {
        const float32x4x4_t p = vld4q_f32(points + 8 * i);
        const float32x4_t x = vsubq_f32(p.val[0], mx), y = vsubq_f32(p.val[1], my);
        const float32x4_t nextX = vsubq_f32(p.val[2], mx), nextY = vsubq_f32(p.val[3], my);
        store(sums.x + i, vaddq_f32(x, nextX));
        store(sums.y + i, vaddq_f32(y, nextY));
        store(sums.xx + i, vmlaq_f32(vmulq_f32(x, x), nextX, nextX));
        store(sums.yy + i, vmlaq_f32(vmulq_f32(y, y), nextY, nextY));
        store(sums.xy + i, vmlaq_f32(vmulq_f32(x, y), nextX, nextY));
    }
    return sums;
}
#endif

/// The same, by the instruction set to use; AVX2 has its own way.
inline BlockSum sumBlock(const float *points, [[maybe_unused]] Level level) {
#if defined(VECTORLIB_SIMD_NEON)
    if (level == Level::Neon)
        return sumBlockNeon(points);
#endif
    return sumBlock(points);
}
/// The same, by the instruction set to use.
inline SumsOfFours sumFours(const float *points, [[maybe_unused]] Level level) {
#if defined(VECTORLIB_SIMD_NEON)
    if (level == Level::Neon)
        return sumFoursNeon(points);
#endif
    return sumFours(points);
}

} // namespace vectorlib::simd
