#include "protocol/mcap/Writer.h"

#include "protocol/mcap/Records.h"

#include <algorithm>
#include <zstd.h>

namespace hermes::mcap {

namespace {

constexpr int zstdLevel = 1; // the fastest: a robot has little to spare

} // namespace

Writer::Writer(Sink sink, const std::string &library, std::size_t chunkBytes, const std::string &profile)
    : sink_(std::move(sink))
    , chunkBytes_(std::min<std::size_t>(chunkBytes, largestChunk))
    , packer_(ZSTD_createCCtx(), ZSTD_freeCCtx) {
    give(beginning(library, profile));
}

std::uint16_t Writer::addSchema(std::string name, std::string encoding, std::string data) {
    const auto id = std::uint16_t(contents_.schemas.size() + 1);
    return add(Op::Schema, Schema{id, std::move(name), std::move(encoding), std::move(data)});
}

std::uint16_t Writer::addChannel(std::uint16_t schema, std::string topic, std::string encoding,
                                 std::map<std::string, std::string> metadata) {
    const auto id = std::uint16_t(contents_.channels.size() + 1);
    if (schema != 0 && contents_.schemas.count(schema) == 0)
        return 0;
    return add(Op::Channel, Channel{id, schema, std::move(topic), std::move(encoding), std::move(metadata)});
}

/// Its id, or 0.
template <typename T>
std::uint16_t Writer::add(Op op, const T &definition) {
    std::string record;
    put(record, op, definition);
    if (definition.id == 0 || !define(contents_, op, std::string_view(record).substr(headBytes)))
        return 0;
    give(record);
    return definition.id;
}

bool Writer::write(const Message &message) {
    if (message.data.size() > largestMessage || contents_.channels.count(message.channel) == 0)
        return false;
    if (records_.size() + messageBytes + message.data.size() > chunkBytes_)
        closeChunk();
    if (ended_)
        return false;
    chunk_.add(message, records_.size());
    put(records_, Op::Message, message);
    return records_.size() < chunkBytes_ || closeChunk();
}

bool Writer::closeChunk() {
    if (records_.empty() || ended_)
        return !ended_;
    const std::size_t bound = ZSTD_compressBound(records_.size());
    packed_.resize(std::max(packed_.size(), bound));
    const std::size_t size =
        ZSTD_compressCCtx(packer_.get(), packed_.data(), bound, records_.data(), records_.size(), zstdLevel);
    const bool isPacked = !ZSTD_isError(size) && size < records_.size();
    const std::string_view stored(isPacked ? std::string_view(packed_.data(), size) : records_);
    chunk_.compression = isPacked ? "zstd" : "";
    chunk_.packedBytes = stored.size();
    chunk_.unpackedBytes = records_.size();
    chunk_.offset = bytes_;
    std::string out;
    putRecord(out, Op::Chunk, chunk_.start_ns, chunk_.end_ns, chunk_.unpackedBytes, sumOf(records_),
              chunk_.compression, chunk_.packedBytes, stored);
    chunk_.bytes = out.size();
    out += chunk_.indexesAt(bytes_ + out.size());
    contents_.add(chunk_);
    chunk_ = {};
    records_.clear();
    return give(out);
}

bool Writer::finish() {
    const bool done = closeChunk() && give(ending(contents_, bytes_));
    ended_ = true;
    return done;
}

bool Writer::give(std::string_view records) {
    ended_ = ended_ || !sink_(records);
    bytes_ += ended_ ? 0 : records.size();
    return !ended_;
}

} // namespace hermes::mcap
