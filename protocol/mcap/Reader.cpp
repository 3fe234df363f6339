#include "protocol/mcap/Reader.h"

#include "protocol/mcap/Records.h"

#include <algorithm>

namespace hermes::mcap {

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
    order_.restart();
}

std::optional<Message> Reader::next() {
    const auto &chunks = found_.contents.chunks;
    const auto records = order_.next(
        {chunks.size(), [&](std::size_t i) { return chunks[i].start_ns; },
         [&](std::size_t i, OpenChunk &open) {
             if (chunks[i].end_ns >= from_ns_ && isWanted(chunks[i]))
                 openChunk(chunks[i], open);
         },
         [&](std::size_t i) {
             file_.note(chunks[i].offset, "too many chunks overlap: messages may come out of order");
         }});
    if (!records)
        return std::nullopt;
    RecordCursor record(*records);
    record.next();
    Message message;
    take(record.content, message);
    return message;
}

bool Reader::isWanted(const Chunk &chunk) const {
    return chunk.indexes.empty() ||
           std::any_of(chunk.indexes.begin(), chunk.indexes.end(),
                       [this](const auto &index) { return unwanted_.count(index.first) == 0; });
}

void Reader::openChunk(const Chunk &told, OpenChunk &open) {
    Chunk chunk = told;
    open.offset = told.offset;
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
}

} // namespace hermes::mcap
