#pragma once

#include "common/Outcome.h"
#include "common/capture/Datagram.h"

#include <functional>
#include <string>

namespace hermes {

/// What stands in a file of PcapWriter from some byte on.
struct PcapTail {
    std::uint64_t packets = 0;
    std::uint64_t wholeBytes = 0; ///< where the last whole record ends
    std::uint64_t fileBytes = 0;
    std::int64_t first_ns = 0; ///< stamps of the first and last of the packets
    std::int64_t last_ns = 0;
};

/// Reads the records from a byte on where one begins, the first of the file where from is less than that of
/// the first; stops at the first that is not whole or not ours. sink sees each datagram.
Outcome<PcapTail> readPcapTail(const std::string &path, std::uint64_t from,
                               const std::function<void(const Datagram &)> &sink);

} // namespace hermes
