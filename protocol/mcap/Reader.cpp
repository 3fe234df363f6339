#include "protocol/mcap/Reader.h"
#include "protocol/mcap/Scan.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <tuple>

namespace hermes::mcap {

namespace {

// Of chunks that overlap and are open at once. With the places of their messages they take up to 1.5 times as
// much memory.
constexpr std::size_t mostOpen = 64;
constexpr std::uint64_t mostOpenBytes = 2 * largestChunk;

} // namespace

struct Reader::OpenChunk {
    struct Entry {
        std::uint64_t time_ns;
        std::size_t offset; ///< of the record in its chunk
    };

    std::size_t number; ///< in the order of the file
    std::string records;
    std::vector<Entry> entries; ///< of messages to give, in order
    std::size_t next = 0;

    auto key() const { return std::tuple(entries[next].time_ns, number); }
};

struct Reader::Source {
    std::unique_ptr<File> file;
    Problems problems;
};

Reader::Reader() = default;
Reader::Reader(Reader &&) noexcept = default;
Reader &Reader::operator=(Reader &&) noexcept = default;
Reader::~Reader() = default;

Outcome<Reader> Reader::open(const std::string &path) {
    auto file = File::open(path);
    if (!file)
        return file.error();
    Reader reader;
    reader.source_ = std::make_unique<Source>(Source{file.take(), {}});
    auto found = readContents(*reader.source_->file, reader.source_->problems);
    if (!found)
        return found.error();
    reader.contents_ = std::move(found->contents);
    reader.whole_ = found->whole;
    const auto &chunks = reader.contents_.chunks;
    reader.order_.resize(chunks.size());
    std::iota(reader.order_.begin(), reader.order_.end(), std::size_t(0));
    std::stable_sort(reader.order_.begin(), reader.order_.end(),
                     [&](std::size_t a, std::size_t b) { return chunks[a].start_ns < chunks[b].start_ns; });
    return reader;
}

void Reader::select(const std::function<bool(const Channel &)> &wanted) {
    unwanted_.clear();
    for (const auto &[id, channel] : contents_.channels)
        if (!wanted(channel))
            unwanted_.insert(id);
    seek(from_ns_);
}

void Reader::seek(std::uint64_t logTime_ns) {
    from_ns_ = logTime_ns;
    nextChunk_ = 0;
    open_.clear();
    given_.reset();
}

std::optional<Message> Reader::next() {
    if (given_) {
        OpenChunk &last = open_[*given_];
        if (++last.next == last.entries.size())
            open_.erase(open_.begin() + std::ptrdiff_t(*given_));
        given_.reset();
    }
    openChunks();
    if (open_.empty())
        return std::nullopt;
    const auto first = std::min_element(open_.begin(), open_.end(),
                                        [](const auto &a, const auto &b) { return a.key() < b.key(); });
    given_ = std::size_t(first - open_.begin());
    Fields record(std::string_view(first->records).substr(first->entries[first->next].offset));
    return toMessage(takeRecord(record)->content);
}

std::string Reader::problem() const {
    return source_->problems.text();
}

/// Until none begins before what comes next.
void Reader::openChunks() {
    for (; nextChunk_ < order_.size(); ++nextChunk_) {
        const Chunk &chunk = contents_.chunks[order_[nextChunk_]];
        const auto isBefore = [&](const OpenChunk &open) { return std::get<0>(open.key()) < chunk.start_ns; };
        if (std::any_of(open_.begin(), open_.end(), isBefore))
            return;
        if (chunk.end_ns < from_ns_ || !isWanted(chunk))
            continue;
        const auto add = [](std::uint64_t sum, const OpenChunk &open) { return sum + open.records.size(); };
        const std::uint64_t bytes = std::accumulate(open_.begin(), open_.end(), std::uint64_t(0), add);
        if (open_.size() == mostOpen || bytes > mostOpenBytes - largestChunk)
            return source_->problems.add(chunk.offset,
                                         "too many chunks overlap: messages may come out of order");
        openChunk(order_[nextChunk_]);
    }
}

bool Reader::isWanted(const Chunk &chunk) const {
    return chunk.indexes.empty() ||
           std::any_of(chunk.indexes.begin(), chunk.indexes.end(),
                       [this](const auto &index) { return unwanted_.count(index.first) == 0; });
}

void Reader::openChunk(std::size_t number) {
    const Chunk &told = contents_.chunks[number];
    Chunk chunk = told;
    OpenChunk open{number, {}, {}};
    if (const auto loaded = loadChunk(*source_->file, chunk, open.records); !loaded)
        return source_->problems.add(chunk.offset, loaded.error());
    Fields left(open.records);
    bool isSound = true;
    for (std::size_t at = 0; const auto record = takeRecord(left);
         at = open.records.size() - left.left().size()) {
        if (record->op != Op::Message)
            continue;
        const auto message = toMessage(record->content);
        if (!message || contents_.channels.count(message->channel) == 0) {
            isSound = false;
            continue;
        }
        isSound = isSound && message->logTime_ns >= told.start_ns && message->logTime_ns <= told.end_ns;
        if (message->logTime_ns >= from_ns_ && unwanted_.count(message->channel) == 0)
            open.entries.push_back({message->logTime_ns, at});
    }
    if (!isSound || !left.ok())
        source_->problems.add(chunk.offset,
                              "the chunk has damaged records, or some of other times or no known channel");
    const auto isEarlier = [](const auto &a, const auto &b) { return a.time_ns < b.time_ns; };
    if (!std::is_sorted(open.entries.begin(), open.entries.end(), isEarlier))
        std::stable_sort(open.entries.begin(), open.entries.end(), isEarlier);
    if (!open.entries.empty())
        open_.push_back(std::move(open));
}

Outcome<Repaired> repair(const std::string &path) {
    auto file = File::open(path);
    if (!file)
        return file.error();
    Problems problems;
    auto found = readContents(**file, problems);
    if (!found)
        return found.error();
    Repaired repaired{std::move(found->contents), (*file)->size(), 0, problems.text()};
    if (found->whole)
        return repaired;
    const std::string end = found->indexes + ending(repaired.contents, found->cut + found->indexes.size());
    repaired.cutBytes = repaired.bytes - found->cut;
    repaired.bytes = found->cut + end.size();
    file->reset();
    const auto name = std::filesystem::u8path(path);
    std::error_code error;
    std::filesystem::resize_file(name, found->cut, error);
    if (error)
        return path + ": cannot be cut: " + error.message();
    std::ofstream stream(name, std::ios::binary | std::ios::app);
    stream.write(end.data(), std::streamsize(end.size())).flush();
    if (!stream)
        return path + ": its end cannot be written";
    return repaired;
}

} // namespace hermes::mcap
