#include "protocol/mcap/Writer.h"
#include "protocol/mcap/Records.h"

#include <algorithm>
#include <zlib.h>
#include <zstd.h>

namespace hermes::mcap {

namespace {

constexpr int zstdLevel = 1; // the fastest: a robot has little to spare

} // namespace

Writer::Writer(Sink sink, std::string library, std::size_t chunkBytes)
    : sink_(std::move(sink))
    , chunkBytes_(std::min<std::size_t>(chunkBytes, largestChunk))
    , packer_(ZSTD_createCCtx(), ZSTD_freeCCtx) {
    std::string begin(magic);
    {
        const PutRecord record(begin, Op::Header);
        putText(begin, ""); // no profile
        putText(begin, library);
    }
    give(begin);
}

std::uint16_t Writer::addSchema(std::string name, std::string encoding, std::string data) {
    const auto id = std::uint16_t(contents_.schemas.size() + 1);
    if (id == 0)
        return 0;
    const Schema &schema =
        contents_.schemas[id] = {id, std::move(name), std::move(encoding), std::move(data)};
    std::string record;
    put(record, schema);
    give(record);
    return id;
}

std::uint16_t Writer::addChannel(std::uint16_t schema, std::string topic, std::string encoding,
                                 std::map<std::string, std::string> metadata) {
    const auto id = std::uint16_t(contents_.channels.size() + 1);
    if (id == 0 || (schema != 0 && contents_.schemas.count(schema) == 0))
        return 0;
    const Channel &channel =
        contents_.channels[id] = {id, schema, std::move(topic), std::move(encoding), std::move(metadata)};
    std::string record;
    put(record, channel);
    give(record);
    return id;
}

bool Writer::write(const Message &message) {
    if (message.data.size() > largestMessage || contents_.channels.count(message.channel) == 0)
        return false;
    if (records_.size() + messageBytes + message.data.size() > chunkBytes_)
        closeChunk();
    if (ended_)
        return false;
    const std::uint64_t time_ns = message.logTime_ns;
    chunk_.start_ns = records_.empty() ? time_ns : std::min(chunk_.start_ns, time_ns);
    chunk_.end_ns = records_.empty() ? time_ns : std::max(chunk_.end_ns, time_ns);
    std::string &index = indexes_[message.channel];
    putNumber(index, time_ns);
    putNumber(index, std::uint64_t(records_.size()));
    put(records_, message);
    ++contents_.counts[message.channel];
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
    {
        const PutRecord record(out, Op::Chunk);
        for (const std::uint64_t value : {chunk_.start_ns, chunk_.end_ns, chunk_.unpackedBytes})
            putNumber(out, value);
        const auto *const bytes = reinterpret_cast<const Bytef *>(records_.data());
        putNumber(out, std::uint32_t(crc32(0, bytes, uInt(records_.size()))));
        putText(out, chunk_.compression);
        putNumber(out, chunk_.packedBytes);
        out += stored;
    }
    chunk_.bytes = out.size();
    putIndexes(out, indexes_, bytes_ + out.size(), chunk_);
    contents_.add(std::move(chunk_));
    chunk_ = {};
    records_.clear();
    indexes_.clear();
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
