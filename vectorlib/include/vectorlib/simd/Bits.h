#pragma once

namespace vectorlib::simd {

/// The number of the highest bit that is set; bits is not 0.
inline unsigned highestBit(unsigned bits) {
#if defined(__GNUC__)
    return 31 - static_cast<unsigned>(__builtin_clz(bits));
#else
    unsigned bit = 0;
    while (bits >>= 1)
        ++bit;
    return bit;
#endif
}
/// The number of the lowest bit that is set; bits is not 0.
inline unsigned lowestBit(unsigned bits) {
#if defined(__GNUC__)
    return static_cast<unsigned>(__builtin_ctz(bits));
#else
    return highestBit(bits & (0 - bits));
#endif
}

} // namespace vectorlib::simd
