#pragma once

#include "common/Time.h"

#include <cstddef>
#include <mutex>
#include <vector>

namespace hermes {

/// Bytes that came in together, in the order of their arrival.
struct ChunkBatch {
    struct Chunk {
        Moment arrival;
        std::size_t size = 0;         ///< bytes
        std::uint64_t lostBefore = 0; ///< bytes dropped just before it
        bool isJump = false;          ///< it does not follow the chunk before: a replay was sought
    };
    std::vector<Chunk> chunks;
    std::vector<char> bytes;     ///< of all chunks
    std::uint64_t lostAtEnd = 0; ///< bytes dropped behind the last chunk

    void clear();
};

/// A bounded queue of what one port received, from its thread to that of a reader. Takes nothing until it is
/// opened. A chunk that does not fit is dropped as a whole and counted.
class ChunkQueue {
public:
    /// capacity: bytes that may wait.
    explicit ChunkQueue(std::size_t capacity)
        : capacity_(capacity) {}

    /// Takes chunks from now on; what waited before is forgotten, and the count of the lost begins anew.
    void open();
    void close();

    /// True when the queue was empty before.
    bool push(const char *bytes, std::size_t size, const Moment &arrival);
    /// The next chunk does not follow the last one.
    void jump();
    /// Whether a chunk of this size would be taken.
    bool hasRoom(std::size_t size) const;
    /// Gives what waits; batch keeps its memory for the next time.
    void take(ChunkBatch &batch);
    /// Bytes dropped since open().
    std::uint64_t lost() const;

private:
    bool fits(std::size_t size) const;

    const std::size_t capacity_;
    mutable std::mutex mutex_; // guards what follows
    bool open_ = false;
    ChunkBatch waiting_;
    std::uint64_t lostNow_ = 0; ///< since the last chunk
    std::uint64_t lost_ = 0;
    bool jumps_ = false; ///< since the last chunk
};

} // namespace hermes
