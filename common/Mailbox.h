#pragma once

#include "common/PriorityMutex.h"

#include <cstdint>
#include <mutex>
#include <sys/eventfd.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace hermes {

/// Values for another thread, in order, for a sender or a receiver that runs in real time: neither waits
/// longer than the other one takes to move a value, and nothing is allocated. The receiver polls
/// descriptor().
template <typename T>
class Mailbox {
public:
    explicit Mailbox(std::size_t capacity)
        : capacity_(capacity)
        , event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
        posted_.reserve(capacity);
        taken_.reserve(capacity);
    }
    ~Mailbox() {
        if (event_ >= 0)
            ::close(event_);
    }
    Mailbox(const Mailbox &) = delete;
    Mailbox &operator=(const Mailbox &) = delete;

    /// Readable when there are values; negative, with errno, when the system has given none.
    int descriptor() const { return event_; }

    /// False, and value is as before, when as many as the capacity wait.
    template <typename Value>
    bool post(Value &&value) {
        {
            const std::lock_guard lock(mutex_);
            if (posted_.size() == capacity_)
                return false;
            posted_.push_back(std::forward<Value>(value));
        }
        const std::uint64_t one = 1;
        // Fails only when 2^64 - 2 values have not been seen: then it is readable.
        [[maybe_unused]] const auto written = ::write(event_, &one, sizeof(one));
        return true;
    }

    /// What has come since the last call; valid until the next one.
    std::vector<T> &take() {
        std::uint64_t count = 0;
        [[maybe_unused]] const auto read = ::read(event_, &count, sizeof(count)); // nothing new: fails
        taken_.clear();
        const std::lock_guard lock(mutex_);
        std::swap(posted_, taken_);
        return taken_;
    }

private:
    const std::size_t capacity_;
    const int event_;
    PriorityMutex mutex_;
    std::vector<T> posted_, taken_;
};

} // namespace hermes
