#include "protocol/mcap/Records.h"

#include <algorithm>
#include <zlib.h>

namespace hermes::mcap {

void Contents::add(Chunk chunk) {
    start_ns = chunks.empty() ? chunk.start_ns : std::min(start_ns, chunk.start_ns);
    end_ns = std::max(end_ns, chunk.end_ns);
    chunks.push_back(std::move(chunk));
}

void putText(std::string &to, std::string_view text) {
    putNumber(to, std::uint32_t(text.size()));
    to += text;
}

PutRecord::PutRecord(std::string &to, Op op)
    : to_(to)
    , begin_(to.size() + headBytes) {
    to += char(op);
    putNumber(to, std::uint64_t(0));
}

PutRecord::~PutRecord() {
    const std::uint64_t length = to_.size() - begin_;
    for (unsigned i = 0; i < 8; ++i)
        to_[begin_ - 8 + i] = char(length >> 8 * i);
}

void put(std::string &to, const Schema &schema) {
    const PutRecord record(to, Op::Schema);
    putNumber(to, schema.id);
    putText(to, schema.name);
    putText(to, schema.encoding);
    putText(to, schema.data);
}

void put(std::string &to, const Channel &channel) {
    const PutRecord record(to, Op::Channel);
    putNumber(to, channel.id);
    putNumber(to, channel.schema);
    putText(to, channel.topic);
    putText(to, channel.encoding);
    std::string metadata;
    for (const auto &[name, value] : channel.metadata) {
        putText(metadata, name);
        putText(metadata, value);
    }
    putText(to, metadata);
}

void put(std::string &to, const Message &message) {
    const PutRecord record(to, Op::Message);
    putNumber(to, message.channel);
    putNumber(to, message.sequence);
    putNumber(to, message.logTime_ns);
    putNumber(to, message.publishTime_ns);
    to += message.data;
}

void putIndexes(std::string &to, const std::map<std::uint16_t, std::string> &entries, std::uint64_t at,
                Chunk &chunk) {
    const std::size_t begin = to.size();
    chunk.indexes.clear();
    for (const auto &[channel, pairs] : entries) {
        chunk.indexes.emplace_back(channel, at + (to.size() - begin));
        const PutRecord record(to, Op::MessageIndex);
        putNumber(to, channel);
        putText(to, pairs);
    }
    chunk.indexBytes = to.size() - begin;
}

namespace {

void put(std::string &to, const Chunk &chunk) {
    const PutRecord record(to, Op::ChunkIndex);
    for (const std::uint64_t value : {chunk.start_ns, chunk.end_ns, chunk.offset, chunk.bytes})
        putNumber(to, value);
    putNumber(to, std::uint32_t(chunk.indexes.size() * (2 + 8)));
    for (const auto &[channel, offset] : chunk.indexes) {
        putNumber(to, channel);
        putNumber(to, offset);
    }
    putNumber(to, chunk.indexBytes);
    putText(to, chunk.compression);
    putNumber(to, chunk.packedBytes);
    putNumber(to, chunk.unpackedBytes);
}

void putStatistics(std::string &to, const Contents &contents) {
    const PutRecord record(to, Op::Statistics);
    std::uint64_t messages = 0;
    for (const auto &[channel, count] : contents.counts)
        messages += count;
    putNumber(to, messages);
    putNumber(to, std::uint16_t(contents.schemas.size()));
    putNumber(to, std::uint32_t(contents.channels.size()));
    putNumber(to, std::uint64_t(0)); // no attachments, no metadata
    putNumber(to, std::uint32_t(contents.chunks.size()));
    putNumber(to, contents.start_ns);
    putNumber(to, contents.end_ns);
    putNumber(to, std::uint32_t(contents.counts.size() * (2 + 8)));
    for (const auto &[channel, count] : contents.counts) {
        putNumber(to, channel);
        putNumber(to, count);
    }
}

} // namespace

std::string ending(const Contents &contents, std::uint64_t at) {
    std::string end;
    {
        const PutRecord record(end, Op::DataEnd);
        putNumber(end, std::uint32_t(0)); // each chunk has a sum of its own
    }
    const std::size_t summary = end.size();
    std::string offsets;
    const auto group = [&](Op op, const auto &putAll) {
        const std::size_t begin = end.size();
        putAll();
        if (end.size() == begin)
            return;
        const PutRecord record(offsets, Op::SummaryOffset);
        putNumber(offsets, std::uint8_t(op));
        putNumber(offsets, std::uint64_t(at + begin));
        putNumber(offsets, std::uint64_t(end.size() - begin));
    };
    group(Op::Schema, [&] {
        for (const auto &[id, schema] : contents.schemas)
            put(end, schema);
    });
    group(Op::Channel, [&] {
        for (const auto &[id, channel] : contents.channels)
            put(end, channel);
    });
    group(Op::Statistics, [&] { putStatistics(end, contents); });
    group(Op::ChunkIndex, [&] {
        for (const Chunk &chunk : contents.chunks)
            put(end, chunk);
    });
    const std::size_t offsetsAt = end.size();
    end += offsets;
    {
        const PutRecord record(end, Op::Footer);
        putNumber(end, std::uint64_t(at + summary));
        putNumber(end, std::uint64_t(at + offsetsAt));
        putNumber(end, std::uint32_t(0));
    }
    // The sum is of all from the summary to the footer's last field, which holds it.
    end.resize(end.size() - 4);
    const auto *const bytes = reinterpret_cast<const Bytef *>(end.data());
    putNumber(end, std::uint32_t(crc32(0, bytes + summary, uInt(end.size() - summary))));
    end += magic;
    return end;
}

std::string_view Fields::bytes(std::uint64_t count) {
    ok_ = ok_ && count <= left_.size();
    const std::string_view taken = left_.substr(0, ok_ ? std::size_t(count) : 0);
    left_ = ok_ ? left_.substr(taken.size()) : std::string_view();
    return taken;
}

std::optional<Record> takeRecord(Fields &from) {
    if (from.left().empty())
        return std::nullopt;
    const auto op = Op(from.number<std::uint8_t>());
    const std::string_view content = from.bytes(from.number<std::uint64_t>());
    return from.ok() ? std::optional<Record>({op, content}) : std::nullopt;
}

std::optional<Schema> toSchema(std::string_view content) {
    Fields fields(content);
    Schema schema;
    schema.id = fields.number<std::uint16_t>();
    schema.name = fields.text();
    schema.encoding = fields.text();
    schema.data = fields.text();
    return fields.ok() && schema.id != 0 ? std::optional(std::move(schema)) : std::nullopt;
}

std::optional<Channel> toChannel(std::string_view content) {
    Fields fields(content);
    Channel channel;
    channel.id = fields.number<std::uint16_t>();
    channel.schema = fields.number<std::uint16_t>();
    channel.topic = fields.text();
    channel.encoding = fields.text();
    Fields metadata(fields.text());
    while (!metadata.left().empty()) {
        std::string name(metadata.text());
        channel.metadata[std::move(name)] = metadata.text();
    }
    return fields.ok() && metadata.ok() ? std::optional(std::move(channel)) : std::nullopt;
}

std::optional<Message> toMessage(std::string_view content) {
    Fields fields(content);
    Message message;
    message.channel = fields.number<std::uint16_t>();
    message.sequence = fields.number<std::uint32_t>();
    message.logTime_ns = fields.number<std::uint64_t>();
    message.publishTime_ns = fields.number<std::uint64_t>();
    message.data = fields.left();
    return fields.ok() ? std::optional(message) : std::nullopt;
}

std::optional<Chunk> toChunk(std::string_view content) {
    Fields fields(content);
    Chunk chunk;
    for (std::uint64_t *const value : {&chunk.start_ns, &chunk.end_ns, &chunk.offset, &chunk.bytes})
        *value = fields.number<std::uint64_t>();
    Fields indexes(fields.text());
    while (!indexes.left().empty()) {
        const auto channel = indexes.number<std::uint16_t>();
        chunk.indexes.emplace_back(channel, indexes.number<std::uint64_t>());
    }
    chunk.indexBytes = fields.number<std::uint64_t>();
    chunk.compression = fields.text();
    chunk.packedBytes = fields.number<std::uint64_t>();
    chunk.unpackedBytes = fields.number<std::uint64_t>();
    return fields.ok() && indexes.ok() ? std::optional(std::move(chunk)) : std::nullopt;
}

} // namespace hermes::mcap
