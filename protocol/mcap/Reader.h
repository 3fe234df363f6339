#pragma once

#include "protocol/mcap/Contents.h"
#include "vectorlib/error/Result.h"

#include <functional>
#include <memory>
#include <optional>
#include <set>

namespace hermes::mcap {

/// Reads one MCAP file: by the summary at its end, or from its beginning where it was cut off. Reads chunks
/// without compression and those of zstd. Bad chunks are left out. Memory: up to 256 MiB of chunks.
class Reader {
public:
    /// Fails when it is no regular file, or none of MCAP. path: in UTF-8.
    static vectorlib::Result<Reader, std::string> open(const std::string &path);
    Reader(Reader &&) noexcept;
    Reader &operator=(Reader &&) noexcept;
    ~Reader();

    const std::map<std::uint16_t, Schema> &schemas() const { return contents_.schemas; }
    const std::map<std::uint16_t, Channel> &channels() const { return contents_.channels; }
    std::uint64_t start_ns() const { return contents_.start_ns; } ///< least log time
    std::uint64_t end_ns() const { return contents_.end_ns; }     ///< greatest log time
    /// Messages of each channel.
    const std::map<std::uint16_t, std::uint64_t> &counts() const { return contents_.counts; }
    bool isWhole() const { return whole_; } ///< it ended in order

    /// Only messages of these channels follow, from where seek() went.
    void select(const std::function<bool(const Channel &)> &wanted);
    /// The first message of that log time or a later one comes next.
    void seek(std::uint64_t logTime_ns);
    /// In the order of log time; those of one time in the order of the file. Its data are valid until the
    /// next call. Nothing at the end. Where more than 64 chunks or 128 MiB of them overlap the order is not
    /// kept, which problem() tells.
    std::optional<Message> next();

    /// What could not be read so far; empty: nothing.
    std::string problem() const;

private:
    struct OpenChunk;
    struct Source; ///< the file, and what could not be read of it

    Reader();
    void openChunks();
    void openChunk(std::size_t number);
    bool isWanted(const Chunk &chunk) const;

    std::unique_ptr<Source> source_;
    Contents contents_;
    bool whole_ = false;
    std::vector<std::size_t> order_; ///< of the chunks, by their least log time
    std::set<std::uint16_t> unwanted_;
    std::uint64_t from_ns_ = 0;
    std::size_t nextChunk_ = 0; ///< in order_
    std::vector<OpenChunk> open_;
    std::optional<std::size_t> given_; ///< of open_: the one whose message was given last
};

/// What repair() found in a file, and what it left there.
struct Repaired {
    Contents contents;
    std::uint64_t bytes = 0;    ///< of the file, now
    std::uint64_t cutBytes = 0; ///< taken off its end
    std::string problem;        ///< what could not be read; empty: nothing
};

/// Cuts a file that was cut off back to its last whole chunk and writes the end that is missing. A file that
/// ended in order stays as it is. Whenever it is interrupted, it can be called again. Not for a file that is
/// still written.
vectorlib::Result<Repaired, std::string> repair(const std::string &path);

} // namespace hermes::mcap
