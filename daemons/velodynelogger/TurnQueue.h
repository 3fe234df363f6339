#pragma once

#include "protocol/velodyne/TurnAssembler.h"

#include <deque>
#include <memory>

namespace hermes::velodynelogger {

/// A turn, and whether it was recorded or is of now: whatever the source is by the time it is taken.
struct FinishedTurn : velodyne::Turn {
    bool replayed = false;
};

/// Finished turns that wait to be taken: so many, the rest is dropped and counted. Not for several threads at
/// once.
class TurnQueue {
public:
    using Turn = std::shared_ptr<const FinishedTurn>;

    explicit TurnQueue(std::size_t capacity)
        : capacity_(capacity) {}

    bool isFull() const { return turns_.size() >= capacity_; }
    /// anyway: beyond the capacity too. False when it was dropped.
    bool push(const Turn &turn, bool anyway) {
        const bool fits = anyway || !isFull();
        if (fits)
            turns_.push_back(turn);
        dropped_ += !fits;
        return fits;
    }
    /// The oldest, or null.
    Turn take() {
        if (turns_.empty())
            return nullptr;
        const Turn turn = std::move(turns_.front());
        turns_.pop_front();
        return turn;
    }
    void clear() { turns_.clear(); }
    std::uint64_t dropped() const { return dropped_; }
    void resetCount() { dropped_ = 0; }

private:
    std::size_t capacity_;
    std::deque<Turn> turns_;
    std::uint64_t dropped_ = 0;
};

} // namespace hermes::velodynelogger
