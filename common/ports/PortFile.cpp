#include "common/ports/PortFile.h"

#include "common/ports/SerialIndex.h"

namespace hermes {

using namespace serialindex;

bool PortFile::open(const QString &base, bool goesOn, std::int64_t toItsClock_ns) {
    toItsClock_ns_ = toItsClock_ns;
    error_.clear();
    first_.reset();
    last_.reset();
    const auto opened = [goesOn](AppendFile &file, const QString &path) {
        return goesOn ? file.resume(path) : file.create(path);
    };
    if (!opened(index_, base + ".index") ||
        (index_.size() == 0 && !index_.append(header.data(), header.size())))
        return fail(index_);
    return opened(raw_, base + ".raw") || fail(raw_);
}

bool PortFile::write(const ChunkBatch &batch) {
    if (batch.chunks.empty())
        return true;
    const quint64 chunksBefore = chunks(), begin = raw_.size();
    records_.resize(batch.chunks.size() * recordSize);
    quint64 offset = begin;
    for (std::size_t i = 0; i < batch.chunks.size(); ++i) {
        const Moment &arrival = batch.chunks[i].arrival;
        encode({offset, {arrival.stamp_ns, arrival.mono_ns + toItsClock_ns_}},
               records_.data() + i * recordSize);
        offset += batch.chunks[i].size;
    }
    const bool indexed = index_.append(records_.data(), records_.size()) || fail(index_);
    const bool written = indexed && (raw_.append(batch.bytes.data(), batch.bytes.size()) || fail(raw_));
    // Only chunks of which something was written stay in the index.
    std::size_t whole = 0;
    for (offset = begin; whole < batch.chunks.size() && offset < raw_.size(); ++whole)
        offset += batch.chunks[whole].size;
    if (!written)
        index_.truncate(headerSize + (chunksBefore + whole) * recordSize);
    if (whole > 0) {
        first_ = first_.value_or(batch.chunks.front().arrival);
        last_ = batch.chunks[whole - 1].arrival;
    }
    return written;
}

quint64 PortFile::chunks() const {
    return index_.size() < headerSize ? 0 : (index_.size() - headerSize) / recordSize;
}

void PortFile::close() {
    index_.close();
    raw_.close();
}

bool PortFile::fail(const AppendFile &file) {
    error_ = file.error();
    failedPath_ = file.path();
    return false;
}

} // namespace hermes
