#include "protocol/mcap/Unpack.h"

namespace hermes::mcap {

// Debian has no zstd for MinGW.
std::string unpackZstd(std::string_view, std::string &) {
    return "found a chunk that zstd has packed, expected one that is not: programs for Windows cannot unpack "
           "it";
}

} // namespace hermes::mcap
