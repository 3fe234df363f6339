#pragma once

#include "protocol/mcap/Contents.h"

#include <functional>
#include <memory>

struct ZSTD_CCtx_s;

namespace hermes::mcap {

enum class Op : std::uint8_t;

/// Makes an MCAP file, with an index, of messages. Its chunks are packed by zstd. Source: specification of
/// MCAP, https://mcap.dev/spec.
class Writer {
public:
    /// Takes whole records, in order. false: it failed, and nothing more is written.
    using Sink = std::function<bool(std::string_view)>;

    /// library: who writes the file. profile: "ros2", or none. chunkBytes: a chunk with as many is closed; it
    /// has more if a single message has.
    Writer(Sink sink, const std::string &library, std::size_t chunkBytes = 1 << 20,
           const std::string &profile = {});

    /// The id of the new schema; 0: there are no more ids, or more than mostDefinitions.
    std::uint16_t addSchema(std::string name, std::string encoding, std::string data);
    /// The id of the new channel; 0: as of a schema, or there is no such schema. schema: 0 for none.
    std::uint16_t addChannel(std::uint16_t schema, std::string topic, std::string encoding,
                             std::map<std::string, std::string> metadata);
    /// false: the sink failed, there is no such channel, or the message is larger than largestMessage.
    bool write(const Message &message);
    /// Gives the sink what is collected. To be called once a second: a file that is cut off loses no more.
    bool closeChunk();
    /// Closes the chunk and gives the sink the end of the file, after which nothing more is written.
    bool finish();

    std::uint64_t bytes() const { return bytes_; } ///< given to the sink

    static constexpr std::size_t largestMessage = largestChunk - 4096;

private:
    template <typename T>
    std::uint16_t add(Op op, const T &definition);
    bool give(std::string_view records);

    Sink sink_;
    std::size_t chunkBytes_;
    bool ended_ = false; ///< finished, or the sink failed
    std::uint64_t bytes_ = 0;
    Contents contents_;
    std::string records_; ///< of the chunk that is collected
    IndexedChunk chunk_;
    std::string packed_;
    std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s *)> packer_;
};

} // namespace hermes::mcap
