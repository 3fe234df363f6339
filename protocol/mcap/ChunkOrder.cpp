#include "protocol/mcap/ChunkOrder.h"

#include "protocol/mcap/Contents.h"

#include <algorithm>
#include <numeric>

namespace hermes::mcap {

namespace {

// Of chunks that overlap and are open at once. With the places of their messages they take up to 1.5 times as
// much memory.
constexpr std::size_t mostOpen = 64;
constexpr std::uint64_t mostOpenBytes = 2 * largestChunk;

} // namespace

void ChunkOrder::restart() {
    nextChunk_ = 0;
    open_.clear();
    given_ = false;
}

std::optional<std::string_view> ChunkOrder::next(const Source &source) {
    if (given_) {
        auto chunk = open_.extract(open_.begin());
        auto &messages = chunk.mapped().messages;
        messages.pop_back();
        if (!messages.empty()) {
            chunk.key().first = messages.back().first;
            open_.insert(std::move(chunk));
        }
    }
    openChunks(source);
    given_ = !open_.empty();
    if (!given_)
        return std::nullopt;
    const OpenChunk &first = open_.begin()->second;
    return std::string_view(first.records).substr(first.messages.back().second);
}

/// Until none begins before what comes next.
void ChunkOrder::openChunks(const Source &source) {
    for (; nextChunk_ < source.chunks; ++nextChunk_) {
        if (!open_.empty() && open_.begin()->first.first < source.start_ns(nextChunk_))
            return;
        const auto add = [](std::uint64_t sum, const auto &open) { return sum + open.second.records.size(); };
        const std::uint64_t bytes = std::accumulate(open_.begin(), open_.end(), std::uint64_t(0), add);
        if (open_.size() == mostOpen || bytes > mostOpenBytes - largestChunk) {
            source.tellThatOrderIsBroken(nextChunk_);
            return;
        }
        OpenChunk open;
        source.open(nextChunk_, open);
        if (open.messages.empty())
            continue;
        std::sort(open.messages.rbegin(), open.messages.rend());
        const std::pair key(open.messages.back().first, open.offset);
        open_.emplace(key, std::move(open));
    }
}

} // namespace hermes::mcap
