#include "common/ports/ChunkQueue.h"

#include <utility>

namespace hermes {

namespace {

constexpr std::size_t maxChunks = 1 << 16; // single bytes are chunks too

} // namespace

void ChunkBatch::clear() {
    chunks.clear();
    bytes.clear();
    lostAtEnd = 0;
}

void ChunkQueue::open() {
    const std::lock_guard<std::mutex> lock(mutex_);
    open_ = true;
    waiting_.clear();
    lostNow_ = 0;
    lost_ = 0;
    jumps_ = false;
}

void ChunkQueue::close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    open_ = false;
}

bool ChunkQueue::push(const char *bytes, std::size_t size, const Moment &arrival) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!open_ || size == 0)
        return false;
    if (!fits(size)) {
        lostNow_ += size;
        lost_ += size;
        return false;
    }
    const bool wasEmpty = waiting_.chunks.empty();
    waiting_.chunks.push_back({arrival, size, std::exchange(lostNow_, 0), std::exchange(jumps_, false)});
    waiting_.bytes.insert(waiting_.bytes.end(), bytes, bytes + size);
    return wasEmpty;
}

void ChunkQueue::jump() {
    const std::lock_guard<std::mutex> lock(mutex_);
    jumps_ = true;
}

bool ChunkQueue::fits(std::size_t size) const {
    return waiting_.bytes.size() + size <= capacity_ && waiting_.chunks.size() < maxChunks;
}

bool ChunkQueue::hasRoom(std::size_t size) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return fits(size);
}

void ChunkQueue::take(ChunkBatch &batch) {
    batch.clear();
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(batch, waiting_);
    batch.lostAtEnd = std::exchange(lostNow_, 0);
}

std::uint64_t ChunkQueue::lost() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return lost_;
}

} // namespace hermes
