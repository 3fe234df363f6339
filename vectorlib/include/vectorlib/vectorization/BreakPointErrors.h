#pragma once

#include "vectorlib/simd/Lanes.h"
#include "vectorlib/simd/Simd.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <cmath>
#include <limits>

namespace vectorlib {

/// The sum of the squared distances of n points from their line: the smaller eigenvalue of their moments; see
/// sumOfSquares() of TlsFit.h.
inline double sumOfSquares(double n, const SumRow &s) {
    const double inverse = 1 / n;
    const double a = s.xx - s.x * s.x * inverse, b = s.yy - s.y * s.y * inverse,
                 c = s.xy - s.x * s.y * inverse;
    const double difference = a - b;
    return 0.5 * (a + b - std::sqrt(difference * difference + 4 * c * c));
}

/// Which of eight places for the cut between two others leaves the least sum of squared distances of all
/// points from their two lines; the first of equal ones.
inline std::size_t bestPlacePlain(const Cut &first, const Cut &end, const Cut *places) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 8; ++i) {
        const double squares =
            sumOfSquares(double(places[i].index - first.index), places[i].row - first.row) +
            sumOfSquares(double(end.index - places[i].index), end.row - places[i].row);
        if (squares < least) {
            least = squares;
            best = i;
        }
    }
    return best;
}

#if defined(VECTORLIB_SIMD_AVX2)
/// Its twin.
VECTORLIB_AVX2 VECTORLIB_INLINE __m256d sumOfSquaresAvx2(__m256d n, __m256d x, __m256d y, __m256d xx,
                                                         __m256d yy, __m256d xy) {
    const __m256d inverse = _mm256_set1_pd(1) / n;
    const __m256d a = xx - x * x * inverse, b = yy - y * y * inverse, c = xy - x * y * inverse;
    const __m256d difference = a - b;
    return _mm256_set1_pd(0.5) *
           (a + b - _mm256_sqrt_pd(difference * difference + _mm256_set1_pd(4) * c * c));
}
/// Bit i: whether value i is the least of eight.
VECTORLIB_AVX2 VECTORLIB_INLINE unsigned leastOfEightAvx2(__m256d low, __m256d high) {
    __m256d least = _mm256_min_pd(low, high);
    least = _mm256_min_pd(least, _mm256_permute2f128_pd(least, least, 1));
    least = _mm256_min_pd(least, _mm256_permute_pd(least, 5));
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(low, least, _CMP_EQ_OQ)) |
                                 _mm256_movemask_pd(_mm256_cmp_pd(high, least, _CMP_EQ_OQ)) << 4);
}
VECTORLIB_AVX2 inline std::size_t bestPlaceAvx2(const Cut &first, const Cut &end, const Cut *places) {
    __m256d squares[2];
    for (int k = 0; k < 2; ++k, places += 4) {
        const auto all = [places](double SumRow::*member) VECTORLIB_AVX2 {
            return _mm256_setr_pd(places[0].row.*member, places[1].row.*member, places[2].row.*member,
                                  places[3].row.*member);
        };
        const __m256d n = _mm256_setr_pd(double(places[0].index), double(places[1].index),
                                         double(places[2].index), double(places[3].index));
        const __m256d x = all(&SumRow::x), y = all(&SumRow::y), xx = all(&SumRow::xx), yy = all(&SumRow::yy),
                      xy = all(&SumRow::xy);
        const __m256d left =
            sumOfSquaresAvx2(n - _mm256_set1_pd(double(first.index)), x - _mm256_set1_pd(first.row.x),
                             y - _mm256_set1_pd(first.row.y), xx - _mm256_set1_pd(first.row.xx),
                             yy - _mm256_set1_pd(first.row.yy), xy - _mm256_set1_pd(first.row.xy));
        const __m256d right =
            sumOfSquaresAvx2(_mm256_set1_pd(double(end.index)) - n, _mm256_set1_pd(end.row.x) - x,
                             _mm256_set1_pd(end.row.y) - y, _mm256_set1_pd(end.row.xx) - xx,
                             _mm256_set1_pd(end.row.yy) - yy, _mm256_set1_pd(end.row.xy) - xy);
        squares[k] = left + right;
    }
    const unsigned bits = leastOfEightAvx2(squares[0], squares[1]);
    return bits == 0 ? 0 : simd::lowestBit(bits); // none where a point is not finite
}
#endif

/// The same, with the instruction set to use.
inline std::size_t bestPlace(const Cut &first, const Cut &end, const Cut *places,
                             [[maybe_unused]] simd::Level level) {
#if defined(VECTORLIB_SIMD_AVX2)
    if (level == simd::Level::Avx2)
        return bestPlaceAvx2(first, end, places);
#endif
    return bestPlacePlain(first, end, places);
}

} // namespace vectorlib
