#include "protocol/mcap/Reader.h"

#include "protocol/mcap/Records.h"

#include <algorithm>
#include <numeric>

namespace hermes::mcap {

namespace {

// Of chunks that overlap and are open at once. With the places of their messages they take up to 1.5 times as
// much memory.
constexpr std::size_t mostOpen = 64;
constexpr std::uint64_t mostOpenBytes = 2 * largestChunk;

} // namespace

Outcome<Reader> Reader::open(const std::string &path) {
    auto file = File::open(path);
    if (!file)
        return file.error();
    auto found = readContents(*file);
    if (!found)
        return found.error();
    return Reader(file.take(), found.take());
}

Reader::Reader(File file, Found found)
    : file_(std::move(file))
    , found_(std::move(found)) {
    auto &chunks = found_.contents.chunks;
    std::stable_sort(chunks.begin(), chunks.end(),
                     [](const Chunk &a, const Chunk &b) { return a.start_ns < b.start_ns; });
}

void Reader::select(const std::function<bool(const Channel &)> &wanted) {
    unwanted_.clear();
    for (const auto &[id, channel] : channels())
        if (!wanted(channel))
            unwanted_.insert(id);
    seek(from_ns_);
}

void Reader::seek(std::uint64_t logTime_ns) {
    from_ns_ = logTime_ns;
    nextChunk_ = 0;
    open_.clear();
    given_ = false;
}

std::optional<Message> Reader::next() {
    if (given_) {
        auto chunk = open_.extract(open_.begin());
        auto &messages = chunk.mapped().messages;
        messages.pop_back();
        if (!messages.empty()) {
            chunk.key().first = messages.back().first;
            open_.insert(std::move(chunk));
        }
    }
    openChunks();
    given_ = !open_.empty();
    if (!given_)
        return std::nullopt;
    const OpenChunk &first = open_.begin()->second;
    RecordCursor record(std::string_view(first.records).substr(first.messages.back().second));
    record.next();
    Message message;
    take(record.content, message);
    return message;
}

/// Until none begins before what comes next.
void Reader::openChunks() {
    const auto &chunks = found_.contents.chunks;
    for (; nextChunk_ < chunks.size(); ++nextChunk_) {
        const Chunk &chunk = chunks[nextChunk_];
        if (!open_.empty() && open_.begin()->first.first < chunk.start_ns)
            return;
        if (chunk.end_ns < from_ns_ || !isWanted(chunk))
            continue;
        const auto add = [](std::uint64_t sum, const auto &open) { return sum + open.second.records.size(); };
        const std::uint64_t bytes = std::accumulate(open_.begin(), open_.end(), std::uint64_t(0), add);
        if (open_.size() == mostOpen || bytes > mostOpenBytes - largestChunk) {
            file_.note(chunk.offset, "too many chunks overlap: messages may come out of order");
            return;
        }
        openChunk(chunk);
    }
}

bool Reader::isWanted(const Chunk &chunk) const {
    return chunk.indexes.empty() ||
           std::any_of(chunk.indexes.begin(), chunk.indexes.end(),
                       [this](const auto &index) { return unwanted_.count(index.first) == 0; });
}

void Reader::openChunk(const Chunk &told) {
    Chunk chunk = told;
    OpenChunk open;
    if (!file_.load(chunk, open.records))
        return;
    bool isInTime = true;
    const auto add = [&](const Message &message, std::size_t at) {
        const std::uint64_t time_ns = message.logTime_ns;
        isInTime = isInTime && time_ns >= told.start_ns && time_ns <= told.end_ns;
        if (time_ns >= from_ns_ && unwanted_.count(message.channel) == 0)
            open.messages.emplace_back(time_ns, at);
    };
    if (!eachMessage(found_.contents, open.records, add) || !isInTime)
        file_.note(chunk.offset, "the chunk has damaged records, or some of other times or no known channel");
    if (open.messages.empty())
        return;
    std::sort(open.messages.rbegin(), open.messages.rend());
    open_.emplace(std::pair(open.messages.back().first, chunk.offset), std::move(open));
}

} // namespace hermes::mcap
