#pragma once

#include "common/capture/Frame.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>

namespace hermes::velodynelogger {

/// A bounded queue of datagrams between two threads, one that pushes and one that pops. Its memory is taken
/// once; neither side locks or allocates for a datagram.
class DatagramRing {
public:
    /// capacity: bytes, of which each datagram takes its payload and some 50 more.
    explicit DatagramRing(std::size_t capacity);

    /// Takes a copy; false when there is no room.
    bool push(const Datagram &datagram);
    /// Wakes the other side up if it waits; once after several push().
    void wake();

    /// The oldest datagram, or false; its payload is valid until pop().
    bool front(Datagram &datagram);
    void pop();
    /// Until there is something, interrupt() was called or the time is over.
    void wait(std::chrono::milliseconds limit);

    /// Any thread: wait() ends at once from now on, or no longer.
    void interrupt(bool on = true);
    /// Bytes that wait. Any thread.
    std::size_t used() const { return head_ - tail_; }
    std::size_t capacity() const { return capacity_; }

private:
    struct Record;
    Record *at(std::size_t position) const;

    const std::size_t capacity_;
    std::unique_ptr<std::uint8_t[]> bytes_;
    alignas(64) std::atomic<std::size_t> head_{0}; ///< bytes pushed since the beginning
    alignas(64) std::atomic<std::size_t> tail_{0}; ///< bytes popped
    std::size_t frontSize_ = 0;                    ///< of the record that front() showed

    std::atomic<bool> waiting_{false};
    std::mutex mutex_; // of the wait alone
    std::condition_variable filled_;
    bool interrupted_ = false;
};

} // namespace hermes::velodynelogger
