#include "protocol/mcap/Records.h"

#include <algorithm>
#include <zlib.h>

namespace hermes::mcap {

namespace {

constexpr std::size_t indexEntryBytes = 8 + 8;
constexpr std::size_t indexHeadBytes = headBytes + 2 + 4; // of the record, its channel and its entries' bytes
constexpr std::uint64_t largestLoose = 1 << 20; // of messages outside of chunks that are read at once

template <typename T>
bool defineIn(std::map<std::uint16_t, T> &known, std::uint64_t &bytes, std::string_view content) {
    T one;
    if (!take(content, one))
        return false;
    if (known.count(one.id) > 0)
        return true;
    if (content.size() > mostDefinitions - bytes || (std::is_same_v<T, Schema> && one.id == 0))
        return false;
    bytes += content.size();
    known.emplace(one.id, std::move(one));
    return true;
}

} // namespace

void IndexedChunk::add(const Message &message, std::uint64_t at) {
    const std::uint64_t time_ns = message.logTime_ns;
    start_ns = entries.empty() ? time_ns : std::min(start_ns, time_ns);
    end_ns = entries.empty() ? time_ns : std::max(end_ns, time_ns);
    std::string &entry = entries[message.channel];
    putField(entry, time_ns);
    putField(entry, at);
}

std::string IndexedChunk::indexesAt(std::uint64_t place) {
    std::string records;
    for (const auto &[channel, pairs] : entries) {
        indexes[channel] = place + records.size();
        putRecord(records, Op::MessageIndex, channel, pairs);
    }
    indexBytes = records.size();
    return records;
}

void Contents::add(Chunk chunk) {
    start_ns = chunks.empty() ? chunk.start_ns : std::min(start_ns, chunk.start_ns);
    end_ns = std::max(end_ns, chunk.end_ns);
    chunks.push_back(std::move(chunk));
}

void Contents::add(const IndexedChunk &chunk) {
    for (const auto &[channel, pairs] : chunk.entries)
        counts[channel] += pairs.size() / indexEntryBytes;
    add(static_cast<const Chunk &>(chunk));
}

void Contents::addLoose(const Message &message, std::uint64_t offset, std::uint64_t bytes) {
    ++counts[message.channel];
    const std::uint64_t time_ns = message.logTime_ns;
    const bool goesOn =
        !chunks.empty() && chunks.back().isLoose && offset + bytes - chunks.back().offset <= largestLoose;
    Chunk chunk = goesOn ? chunks.back() : Chunk();
    if (goesOn)
        chunks.pop_back();
    else
        chunk.offset = offset;
    chunk.start_ns = goesOn ? std::min(chunk.start_ns, time_ns) : time_ns;
    chunk.end_ns = std::max(chunk.end_ns, time_ns);
    chunk.isLoose = true;
    chunk.bytes = offset + bytes - chunk.offset;
    add(std::move(chunk));
}

bool Contents::isAllIndexed() const {
    std::uint64_t messages = 0, indexed = 0;
    for (const auto &[channel, count] : counts)
        messages += count;
    for (const Chunk &chunk : chunks)
        indexed += (chunk.indexBytes -
                    std::min<std::uint64_t>(chunk.indexBytes, indexHeadBytes * chunk.indexes.size())) /
                   indexEntryBytes;
    return messages == indexed;
}

bool RecordCursor::next() {
    std::string_view from = left_;
    std::uint8_t first = 0;
    std::uint64_t length = 0;
    if (!takeField(from, first) || !takeField(from, length) || length > from.size())
        return false;
    at = size_ - left_.size();
    op = Op(first);
    content = from.substr(0, std::size_t(length));
    left_ = from.substr(content.size());
    return true;
}

bool define(Contents &contents, Op op, std::string_view content) {
    if (op == Op::Schema)
        return defineIn(contents.schemas, contents.definitionBytes, content);
    return op != Op::Channel || defineIn(contents.channels, contents.definitionBytes, content);
}

std::string beginning(const std::string &library, const std::string &profile) {
    std::string begin(magic);
    putRecord(begin, Op::Header, profile, library);
    return begin;
}

std::string ending(const Contents &contents, std::uint64_t at) {
    std::string end;
    putRecord(end, Op::DataEnd, std::uint32_t(0)); // each chunk has a sum of its own
    const std::size_t summary = end.size();
    for (const auto &[id, schema] : contents.schemas)
        put(end, Op::Schema, schema);
    for (const auto &[id, channel] : contents.channels)
        put(end, Op::Channel, channel);
    std::uint64_t messages = 0;
    for (const auto &[channel, count] : contents.counts)
        messages += count;
    const std::uint32_t attachments = 0, metadata = 0;
    const auto isChunk = [](const Chunk &chunk) { return !chunk.isLoose; };
    putRecord(end, Op::Statistics, messages, std::uint16_t(contents.schemas.size()),
              std::uint32_t(contents.channels.size()), attachments, metadata,
              std::uint32_t(std::count_if(contents.chunks.begin(), contents.chunks.end(), isChunk)),
              contents.start_ns, contents.end_ns, contents.counts);
    for (const Chunk &chunk : contents.chunks)
        if (isChunk(chunk))
            put(end, Op::ChunkIndex, chunk);
    putRecord(end, Op::Footer, at + summary, std::uint64_t(0), std::uint32_t(0)); // no offsets of groups
    // The sum is of all from the summary to the footer's last field, which holds it.
    end.resize(end.size() - 4);
    putField(end, sumOf(std::string_view(end).substr(summary)));
    end += magic;
    return end;
}

std::uint32_t sumOf(std::string_view bytes, std::uint32_t before) {
    return std::uint32_t(crc32(before, reinterpret_cast<const Bytef *>(bytes.data()), uInt(bytes.size())));
}

} // namespace hermes::mcap
