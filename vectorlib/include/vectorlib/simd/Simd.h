#pragma once

#include <cstddef>
#include <cstdint>

// VECTORLIB_PLAIN leaves all of it out.
#if defined(VECTORLIB_PLAIN)
#elif (defined(__x86_64__) || defined(__i386__)) && defined(__GNUC__)
#define VECTORLIB_SIMD_AVX2 1
#define VECTORLIB_AVX2 __attribute__((target("avx2,fma")))
#include <immintrin.h>
#elif defined(__ARM_NEON) // for the whole program, as always on AArch64
#define VECTORLIB_SIMD_NEON 1
#define VECTORLIB_NEON
#include <arm_neon.h>
#elif defined(__arm__) && defined(__linux__) && __ARM_ARCH >= 7 && __ARM_FP && defined(__GNUC__) &&          \
    !defined(__clang__)
#define VECTORLIB_SIMD_NEON 1
#define VECTORLIB_NEON __attribute__((target("fpu=neon")))
#define VECTORLIB_NEON_AT_RUN_TIME 1
#include <arm_neon.h>
#include <asm/hwcap.h>
#include <sys/auxv.h>
#endif

#if defined(__GNUC__)
#define VECTORLIB_COLD __attribute__((cold, noinline))
#define VECTORLIB_INLINE __attribute__((always_inline)) inline
#else
#define VECTORLIB_COLD
#define VECTORLIB_INLINE inline
#endif

/// The few loops over points that are worth explicit SIMD. Each has a scalar twin that does the same
/// operations in the same order, so that results do not depend on the processor (where the compiler contracts
/// no products and sums: -ffp-contract=off) but for denormal floats, which NEON of ARMv7 takes for 0. The
/// instruction set is chosen at run time.
namespace vectorlib::simd {

/// The instruction sets that loops are written for.
enum class Level {
    Scalar, ///< none: plain loops
    Neon,   ///< NEON of ARM
    Avx2    ///< AVX2 and FMA of x86
};

/// The best that this processor and this build can do.
inline Level bestLevel() {
#if defined(VECTORLIB_SIMD_AVX2)
    static const Level level =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? Level::Avx2 : Level::Scalar;
    return level;
#elif defined(VECTORLIB_NEON_AT_RUN_TIME)
    static const Level level = getauxval(AT_HWCAP) & HWCAP_NEON ? Level::Neon : Level::Scalar;
    return level;
#elif defined(VECTORLIB_SIMD_NEON)
    return Level::Neon;
#else
    return Level::Scalar;
#endif
}

} // namespace vectorlib::simd
