#pragma once

#include <QtGlobal>
#include <cstddef>

namespace hermes {

/// CRC-32C (Castagnoli), as of RFC 3720, 12.1.
quint32 crc32c(const void *bytes, std::size_t size);

} // namespace hermes
