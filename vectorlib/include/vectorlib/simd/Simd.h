#pragma once

#include <cstddef>
#include <cstdint>

#if (defined(__x86_64__) || defined(__i386__)) && defined(__GNUC__)
#define VECTORLIB_SIMD_AVX2 1
#define VECTORLIB_AVX2 __attribute__((target("avx2")))
#include <immintrin.h>
#elif defined(__ARM_NEON)
#define VECTORLIB_SIMD_NEON 1
#include <arm_neon.h>
#endif

#if defined(__GNUC__)
#define VECTORLIB_COLD __attribute__((cold, noinline))
#else
#define VECTORLIB_COLD
#endif

/// The few loops over points that are worth explicit SIMD. Each has a scalar twin that does the same
/// operations in the same order, so that results do not depend on the processor (where the compiler contracts
/// no products and sums: -ffp-contract=off). The instruction set is chosen at run time on x86, at compile
/// time on ARM.
namespace vectorlib::simd {

enum class Level { Scalar, Neon, Avx2 };

/// The best that this processor and this build can do.
inline Level bestLevel() {
#if defined(VECTORLIB_SIMD_AVX2)
    static const Level level = __builtin_cpu_supports("avx2") ? Level::Avx2 : Level::Scalar;
    return level;
#elif defined(VECTORLIB_SIMD_NEON)
    return Level::Neon;
#else
    return Level::Scalar;
#endif
}

/// The five sums of eight points or of a whole number of eights, relative to an origin.
struct Sums {
    float x, y, xx, yy, xy;
};

/// The sums of `eights` * 8 points (x, y alternating) relative to (ox, oy). Eight lanes, added up in pairs.
inline Sums sumScalar(const float *p, std::size_t eights, float ox, float oy) {
    constexpr std::size_t lane[8] = {0, 1, 4, 5, 2, 3, 6, 7}; // the order that unpacking of registers gives
    float x[8] = {}, y[8] = {}, xx[8] = {}, yy[8] = {}, xy[8] = {};
    for (std::size_t e = 0; e < eights; ++e, p += 16)
        for (std::size_t i = 0; i < 8; ++i) {
            const float dx = p[2 * lane[i]] - ox, dy = p[2 * lane[i] + 1] - oy;
            x[i] += dx;
            y[i] += dy;
            xx[i] += dx * dx;
            yy[i] += dy * dy;
            xy[i] += dx * dy;
        }
    const auto total = [](const float *v) {
        return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
    };
    return {total(x), total(y), total(xx), total(yy), total(xy)};
}

#if defined(VECTORLIB_SIMD_AVX2)
VECTORLIB_AVX2 inline Sums sumAvx2(const float *p, std::size_t eights, float ox, float oy) {
    const __m256 originX = _mm256_set1_ps(ox), originY = _mm256_set1_ps(oy);
    __m256 x = _mm256_setzero_ps(), y = x, xx = x, yy = x, xy = x;
    for (std::size_t e = 0; e < eights; ++e, p += 16) {
        const __m256 a = _mm256_loadu_ps(p), b = _mm256_loadu_ps(p + 8);
        const __m256 dx = _mm256_sub_ps(_mm256_shuffle_ps(a, b, 0x88), originX);
        const __m256 dy = _mm256_sub_ps(_mm256_shuffle_ps(a, b, 0xdd), originY);
        x = _mm256_add_ps(x, dx);
        y = _mm256_add_ps(y, dy);
        xx = _mm256_add_ps(xx, _mm256_mul_ps(dx, dx));
        yy = _mm256_add_ps(yy, _mm256_mul_ps(dy, dy));
        xy = _mm256_add_ps(xy, _mm256_mul_ps(dx, dy));
    }
    const __m256 four = _mm256_hadd_ps(_mm256_hadd_ps(x, y), _mm256_hadd_ps(xx, yy));
    const __m256 last = _mm256_hadd_ps(xy, xy), one = _mm256_hadd_ps(last, last);
    const __m128 f = _mm_add_ps(_mm256_castps256_ps128(four), _mm256_extractf128_ps(four, 1));
    const __m128 o = _mm_add_ps(_mm256_castps256_ps128(one), _mm256_extractf128_ps(one, 1));
    Sums s;
    _mm_storeu_ps(&s.x, f);
    s.xy = _mm_cvtss_f32(o);
    return s;
}
#endif

} // namespace vectorlib::simd
