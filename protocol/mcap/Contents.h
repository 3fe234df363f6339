#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hermes::mcap {

/// How the bytes of a channel's messages are to be understood.
struct Schema {
    std::uint16_t id = 0; ///< not 0
    std::string name, encoding, data;
};

struct Channel {
    std::uint16_t id = 0, schema = 0; ///< schema 0: none
    std::string topic, encoding;
    std::map<std::string, std::string> metadata;
};

struct Message {
    std::uint16_t channel = 0;
    std::uint32_t sequence = 0;
    std::uint64_t logTime_ns = 0, publishTime_ns = 0;
    std::string_view data;
};

/// Where a chunk of messages stands in its file.
struct Chunk {
    std::uint64_t start_ns = 0, end_ns = 0; ///< least and greatest log time
    std::uint64_t offset = 0, bytes = 0;    ///< of the whole record in the file
    /// Of each channel with messages in it: where its index stands in the file.
    std::vector<std::pair<std::uint16_t, std::uint64_t>> indexes;
    std::uint64_t indexBytes = 0;
    std::string compression; ///< "zstd", or empty: none
    std::uint64_t packedBytes = 0, unpackedBytes = 0;
};

/// What a file tells about itself at its end.
struct Contents {
    std::map<std::uint16_t, Schema> schemas;
    std::map<std::uint16_t, Channel> channels;
    std::map<std::uint16_t, std::uint64_t> counts; ///< messages of each channel
    std::vector<Chunk> chunks;                     ///< in the order of the file
    std::uint64_t start_ns = 0, end_ns = 0;        ///< least and greatest log time; 0 without chunks

    /// Appends a chunk; start and end follow.
    void add(Chunk chunk);
};

/// No chunk is larger, packed or not: more is neither written nor read.
constexpr std::uint64_t largestChunk = 64 << 20;

} // namespace hermes::mcap
