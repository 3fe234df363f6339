#pragma once

#include "vectorlib/simd/SumBlocks.h"

namespace vectorlib::simd {

#if defined(VECTORLIB_SIMD_NEON)
VECTORLIB_NEON VECTORLIB_INLINE double totalNeon(float32x4_t v) {
    const float32x2_t pairs = vpadd_f32(vget_low_f32(v), vget_high_f32(v));
    return vget_lane_f32(vpadd_f32(pairs, pairs), 0);
}

/// The twin of sumFourBlocks(). Its lanes 0, 2, 4 and 6 are those of x here, the others those of y.
VECTORLIB_NEON inline FourSums sumFourBlocksNeon(const float *points) {
    FourSums sums;
    const float32x4_t zero = vdupq_n_f32(0);
    for (int b = 0; b < 4; ++b, points += 2 * blockPoints) {
        const float32x4_t mx = vdupq_n_f32(points[blockPoints]), my = vdupq_n_f32(points[blockPoints + 1]);
        float32x4_t sx = zero, sy = zero, sxx = zero, syy = zero, products[2] = {zero, zero};
        for (std::size_t i = 0; i < 2 * blockPoints; i += 16)
            for (std::size_t half = 0; half < 2; ++half) {
                const float32x4x2_t p = vld2q_f32(points + i + 8 * half);
                const float32x4_t dx = vsubq_f32(p.val[0], mx), dy = vsubq_f32(p.val[1], my);
                sx = vaddq_f32(sx, dx);
                sy = vaddq_f32(sy, dy);
                sxx = vmlaq_f32(sxx, dx, dx); // on ARMv7 the product is rounded, too
                syy = vmlaq_f32(syy, dy, dy);
                products[half] = vmlaq_f32(products[half], dx, dy);
            }
        const float32x4_t four = vaddq_f32(products[0], products[1]);
        const float32x2_t two = vadd_f32(vget_low_f32(four), vget_high_f32(four));
        sums.x[b] = totalNeon(sx);
        sums.y[b] = totalNeon(sy);
        sums.xx[b] = totalNeon(sxx);
        sums.yy[b] = totalNeon(syy);
        sums.xy[b] = double(vget_lane_f32(two, 0)) + double(vget_lane_f32(two, 1));
    }
    return sums;
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

// By the instruction set to use; AVX2 has its own way.
inline FourSums sumFourBlocks(const float *points, [[maybe_unused]] Level level) {
#if defined(VECTORLIB_SIMD_NEON)
    if (level == Level::Neon)
        return sumFourBlocksNeon(points);
#endif
    return sumFourBlocks(points);
}
inline SumsOfFours sumFours(const float *points, [[maybe_unused]] Level level) {
#if defined(VECTORLIB_SIMD_NEON)
    if (level == Level::Neon)
        return sumFoursNeon(points);
#endif
    return sumFours(points);
}

} // namespace vectorlib::simd
