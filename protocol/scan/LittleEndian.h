#pragma once

#include <cstdint>

namespace hermes::scan {

inline int word(const std::uint8_t *bytes) {
    return bytes[0] | bytes[1] << 8;
}

inline std::uint32_t longWord(const std::uint8_t *bytes) {
    return std::uint32_t(word(bytes)) | std::uint32_t(word(bytes + 2)) << 16;
}

} // namespace hermes::scan
