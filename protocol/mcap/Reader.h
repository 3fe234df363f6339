#pragma once

#include "protocol/mcap/ChunkOrder.h"
#include "protocol/mcap/Scan.h"

#include <functional>
#include <optional>
#include <set>

namespace hermes::mcap {

/// Reads one MCAP file: by the summary at its end, or from its beginning where it was cut off or has messages
/// outside of chunks. Reads chunks without compression and those of zstd and lz4. Bad chunks are left out.
/// Memory: up to 256 MiB of chunks.
class Reader {
public:
    /// Fails when it is no regular file, or none of MCAP. path: in UTF-8.
    static Outcome<Reader> open(const std::string &path);

    const std::map<std::uint16_t, Schema> &schemas() const { return found_.contents.schemas; }
    const std::map<std::uint16_t, Channel> &channels() const { return found_.contents.channels; }
    std::uint64_t start_ns() const { return found_.contents.start_ns; } ///< least log time
    std::uint64_t end_ns() const { return found_.contents.end_ns; }     ///< greatest log time
    /// Messages of each channel.
    const std::map<std::uint16_t, std::uint64_t> &counts() const { return found_.contents.counts; }
    bool isWhole() const { return found_.whole; } ///< it ended in order

    /// Only messages of these channels follow, from where seek() went.
    void select(const std::function<bool(const Channel &)> &wanted);
    /// The first message of that log time or a later one comes next.
    void seek(std::uint64_t logTime_ns);
    /// In the order of log time; those of one time in the order of the file. Its data are valid until the
    /// next call. Nothing at the end. Where more than 64 chunks or 128 MiB of them overlap the order is not
    /// kept, which problem() tells.
    std::optional<Message> next();

    /// What could not be read so far; empty: nothing.
    std::string problem() const { return file_.problem(); }

private:
    Reader(File file, Found found);
    void openChunk(const Chunk &told, OpenChunk &open);
    bool isWanted(const Chunk &chunk) const;

    File file_;
    Found found_; ///< its chunks in the order of their least log times
    std::set<std::uint16_t> unwanted_;
    std::uint64_t from_ns_ = 0;
    ChunkOrder order_;
};

} // namespace hermes::mcap
