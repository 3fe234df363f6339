#include "protocol/mcap/Unpack.h"

#include <zstd.h>

namespace hermes::mcap {

std::string unpackZstd(std::string_view packed, std::string &to) {
    const std::size_t size = ZSTD_decompress(to.data(), to.size(), packed.data(), packed.size());
    if (ZSTD_isError(size))
        return ZSTD_getErrorName(size);
    to.resize(size);
    return {};
}

} // namespace hermes::mcap
