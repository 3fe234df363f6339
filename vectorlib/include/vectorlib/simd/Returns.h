#pragma once

#include "vectorlib/simd/Simd.h"

/// The returns of a scan, packed. The scalar twin is PolarScan::returns().
namespace vectorlib::simd {

/// Metres in a unit of range; a return is at least `least` and less than `end`.
struct RangeBounds {
    double scale, least, end;
};

#if defined(VECTORLIB_SIMD_AVX2)
/// Eight ranges as doubles.
struct EightRanges {
    __m256d low, high;
};
VECTORLIB_AVX2 inline EightRanges load(const float *p) {
    return {_mm256_cvtps_pd(_mm_loadu_ps(p)), _mm256_cvtps_pd(_mm_loadu_ps(p + 4))};
}
VECTORLIB_AVX2 inline EightRanges load(const std::uint16_t *p) {
    const __m256i v = _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i *>(p)));
    return {_mm256_cvtepi32_pd(_mm256_castsi256_si128(v)),
            _mm256_cvtepi32_pd(_mm256_extracti128_si256(v, 1))};
}

/// Writes those of 8 * eights ranges that are returns, in metres, and the numbers of their rays; returns
/// their number. There must be room for eight more.
template <typename Range>
VECTORLIB_AVX2 inline std::size_t returns(const Range *raw, std::size_t eights, RangeBounds b, float *ranges,
                                          int *rays) {
    const __m256d scale = _mm256_set1_pd(b.scale), least = _mm256_set1_pd(b.least),
                  end = _mm256_set1_pd(b.end);
    __m256i ray = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    std::size_t count = 0;
    for (std::size_t e = 0; e < eights; ++e, raw += 8) {
        EightRanges r = load(raw);
        r = {_mm256_mul_pd(r.low, scale), _mm256_mul_pd(r.high, scale)};
        const __m256d low =
            _mm256_and_pd(_mm256_cmp_pd(r.low, least, _CMP_GE_OQ), _mm256_cmp_pd(r.low, end, _CMP_LT_OQ));
        const __m256d high =
            _mm256_and_pd(_mm256_cmp_pd(r.high, least, _CMP_GE_OQ), _mm256_cmp_pd(r.high, end, _CMP_LT_OQ));
        const int valid = _mm256_movemask_pd(low) | _mm256_movemask_pd(high) << 4;
        const __m256 metres = _mm256_set_m128(_mm256_cvtpd_ps(r.high), _mm256_cvtpd_ps(r.low));
        if (valid == 0xff) {
            _mm256_storeu_ps(ranges + count, metres);
            _mm256_storeu_si256(reinterpret_cast<__m256i *>(rays + count), ray);
            count += 8;
        } else {
            alignas(32) float eight[8];
            _mm256_store_ps(eight, metres);
            for (int k = 0; k < 8; ++k) { // overwritten where it is no return
                ranges[count] = eight[k];
                rays[count] = static_cast<int>(8 * e) + k;
                count += static_cast<std::size_t>(valid >> k & 1);
            }
        }
        ray = _mm256_add_epi32(ray, _mm256_set1_epi32(8));
    }
    return count;
}
#endif

} // namespace vectorlib::simd
