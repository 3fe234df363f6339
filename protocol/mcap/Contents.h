#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
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
    std::uint64_t start_ns = 0, end_ns = 0;         ///< least and greatest log time
    std::uint64_t offset = 0, bytes = 0;            ///< of the whole record in the file
    std::map<std::uint16_t, std::uint64_t> indexes; ///< where those of its channels stand in the file
    std::uint64_t indexBytes = 0;
    std::string compression; ///< "zstd", "lz4", or empty: none
    bool isLoose = false;    ///< no chunk: records that stand in the file themselves, and some between them
    std::uint64_t packedBytes = 0, unpackedBytes = 0;
};

/// A chunk while its messages are written, or found.
struct IndexedChunk : Chunk {
    std::map<std::uint16_t, std::string> entries; ///< of each channel: log times and offsets, as in the file

    /// at: where among the records of the chunk the message begins.
    void add(const Message &message, std::uint64_t at);
    /// The indexes of its channels as records, which from now on stand there in the file.
    std::string indexesAt(std::uint64_t place);
};

/// What a file tells about itself at its end.
struct Contents {
    std::map<std::uint16_t, Schema> schemas;
    std::map<std::uint16_t, Channel> channels;
    std::uint64_t definitionBytes = 0;             ///< of schemas and channels
    std::map<std::uint16_t, std::uint64_t> counts; ///< messages of each channel
    std::vector<Chunk> chunks;                     ///< in the order of the file
    std::uint64_t start_ns = 0, end_ns = 0;        ///< least and greatest log time; 0 without chunks

    /// Whether the indexes of the chunks are of all messages.
    bool isAllIndexed() const;

    /// Appends a chunk; start and end follow.
    void add(Chunk chunk);
    /// A message of a known channel outside of chunks, whose record stands there in the file.
    void addLoose(const Message &message, std::uint64_t offset, std::uint64_t bytes);
    /// Its messages are counted, too.
    void add(const IndexedChunk &chunk);
};

/// No chunk is larger, packed or not: more is neither written nor read.
constexpr std::uint64_t largestChunk = 64 << 20;
/// Nor has any file more schemas and channels, in bytes: a chunk of a few bytes may be unpacked to many.
constexpr std::uint64_t mostDefinitions = 16 << 20;

} // namespace hermes::mcap
