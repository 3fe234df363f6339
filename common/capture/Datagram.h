#pragma once

#include <cstddef>
#include <cstdint>

namespace hermes {

/// A UDP datagram over IPv4 as it was received. Addresses and ports in the host's byte order.
struct Datagram {
    std::int64_t stamp_ns = 0; ///< when it was received, since the Unix epoch
    std::uint32_t source = 0;
    std::uint32_t destination = 0;
    std::uint16_t sourcePort = 0;
    std::uint16_t destinationPort = 0;
    const std::uint8_t *payload = nullptr; ///< kept by whoever made the datagram
    std::size_t size = 0;
};

} // namespace hermes
