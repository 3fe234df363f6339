#include "daemons/velodynelogger/DatagramRing.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace hermes::velodynelogger {

namespace {

constexpr std::size_t alignment = 16;

std::size_t roundUp(std::size_t bytes) {
    return (bytes + alignment - 1) / alignment * alignment;
}

} // namespace

/// Stands before each payload; a skip fills the end of the memory where the next record does not fit.
struct alignas(alignment) DatagramRing::Record {
    Datagram datagram;
    std::size_t bytes; ///< with this header, rounded up
    bool skip;
};

DatagramRing::DatagramRing(std::size_t capacity)
    : capacity_(roundUp(std::max(capacity, 2 * roundUp(sizeof(Record)))))
    , bytes_(new std::uint8_t[capacity_]) {} // new[] aligns to 16

DatagramRing::Record *DatagramRing::at(std::size_t position) const {
    return reinterpret_cast<Record *>(bytes_.get() + position % capacity_);
}

bool DatagramRing::push(const Datagram &datagram) {
    static_assert(sizeof(Record) % alignment == 0, "payload and skip follow a record");
    const std::size_t need = sizeof(Record) + roundUp(datagram.size);
    std::size_t head = head_;
    const std::size_t untilEnd = capacity_ - head % capacity_;
    const std::size_t skip = need > untilEnd ? untilEnd : 0;
    if (head + skip + need - tail_ > capacity_)
        return false;
    if (skip > 0) {
        if (skip >= sizeof(Record))
            new (at(head)) Record{{}, skip, true}; // what is too small for a header both sides skip unasked
        head += skip;
    }
    Record *record = new (at(head)) Record{datagram, need, false};
    auto *payload = reinterpret_cast<std::uint8_t *>(record + 1);
    record->datagram.payload = payload;
    if (datagram.size > 0)
        std::memcpy(payload, datagram.payload, datagram.size);
    head_ = head + need;
    return true;
}

void DatagramRing::wake() {
    if (!waiting_)
        return;
    const std::lock_guard<std::mutex> lock(mutex_);
    filled_.notify_one();
}

bool DatagramRing::front(Datagram &datagram) {
    std::size_t tail = tail_;
    if (tail == head_)
        return false;
    const std::size_t untilEnd = capacity_ - tail % capacity_;
    if (untilEnd < sizeof(Record))
        tail += untilEnd;
    else if (at(tail)->skip)
        tail += at(tail)->bytes;
    datagram = at(tail)->datagram;
    frontSize_ = tail + at(tail)->bytes - tail_;
    return true;
}

void DatagramRing::pop() {
    tail_ = tail_ + frontSize_;
}

void DatagramRing::wait(std::chrono::milliseconds limit) {
    std::unique_lock<std::mutex> lock(mutex_);
    waiting_ = true; // before the queue is looked at, as the other side pushes before it looks at this
    filled_.wait_for(lock, limit, [this] { return interrupted_ || head_ != tail_; });
    waiting_ = false;
}

void DatagramRing::interrupt(bool on) {
    const std::lock_guard<std::mutex> lock(mutex_);
    interrupted_ = on;
    filled_.notify_one();
}

} // namespace hermes::velodynelogger
