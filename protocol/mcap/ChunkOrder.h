#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hermes::mcap {

/// A chunk whose messages are given.
struct OpenChunk {
    std::uint64_t offset = 0; ///< of the chunk in the file
    std::string records;
    /// To give, the next one last: log time, and where the message begins in the records.
    std::vector<std::pair<std::uint64_t, std::size_t>> messages;
};

/// Gives the messages of chunks that may overlap in the order of their times. Memory: up to 64 chunks, or
/// 256 MiB of them. Where more overlap the order is not kept, which is told.
class ChunkOrder {
public:
    /// Of chunks in the order of their least times.
    struct Source {
        std::size_t chunks = 0;
        std::function<std::uint64_t(std::size_t)> start_ns;     ///< least time of a chunk
        std::function<void(std::size_t, OpenChunk &)> open;     ///< without messages: none are wanted
        std::function<void(std::size_t)> tellThatOrderIsBroken; ///< too many chunks overlap that one
    };

    /// Begins anew with the first chunk.
    void restart();
    /// The records of its chunk from the next message on, valid until the next call. Nothing at the end.
    std::optional<std::string_view> next(const Source &source);

private:
    void openChunks(const Source &source);

    std::size_t nextChunk_ = 0;
    /// By the time of the next message, and the place in the file.
    std::map<std::pair<std::uint64_t, std::uint64_t>, OpenChunk> open_;
    bool given_ = false; ///< the next message of the first of them
};

} // namespace hermes::mcap
