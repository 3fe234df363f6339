#pragma once

#include "protocol/bag/Ros1Records.h"
#include "protocol/mcap/File.h"

#include <string>

namespace hermes::bag {

/// Where a record of a bag stands, and its header.
struct Ros1Head {
    Ros1Head() = default;
    Ros1Head(const Ros1Head &) = delete; // its fields are of its own bytes

    std::string bytes; ///< that the fields are of
    Ros1Op op = Ros1Op::FileHeader;
    Ros1Fields fields;
    std::uint64_t at = 0, dataAt = 0, dataBytes = 0;

    std::uint64_t end() const { return dataAt + dataBytes; }
};

/// A .bag 2.0, record by record.
class Ros1File : public mcap::File {
public:
    explicit Ros1File(mcap::File file)
        : mcap::File(std::move(file)) {}

    /// Where the first byte stands from there on that is not of padding: no record begins with four zeros.
    std::uint64_t skipZeros(std::uint64_t offset);
    /// false: there is no record, which is noted. Its data may be cut off.
    bool readHead(std::uint64_t offset, Ros1Head &head);
    /// The records of a chunk; of one that is cut off and not packed those that are there. false: they cannot
    /// be had, which is noted.
    bool unpack(const Ros1Head &head, std::string &records);
};

/// "17 bytes".
std::string bytesText(std::uint64_t bytes);

} // namespace hermes::bag
