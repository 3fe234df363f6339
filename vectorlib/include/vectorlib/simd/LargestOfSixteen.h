#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace vectorlib::simd {

/// The largest of sixteen numbers.
inline std::int16_t largestOfSixteen(const std::int16_t *numbers) {
#if defined(__clang__) || __GNUC__ >= 12
    typedef std::int16_t Shorts __attribute__((vector_size(16)));
    Shorts a, b;
    std::memcpy(&a, numbers, sizeof a);
    std::memcpy(&b, numbers + 8, sizeof b);
    a = a > b ? a : b;
    b = __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3);
    a = a > b ? a : b;
    b = __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5);
    a = a > b ? a : b;
    return std::max(a[0], a[1]);
#else
    return *std::max_element(numbers, numbers + 16);
#endif
}

} // namespace vectorlib::simd
