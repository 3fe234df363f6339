#include "daemons/softwaretrigger/Schedule.h"

#include "common/Realtime.h"

#include <algorithm>
#include <sys/prctl.h>
#include <vector>

namespace hermes::softwaretrigger {
Schedule::Schedule()
    : thread_([this] { run(); }) {}

Schedule::~Schedule() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

quint64 Schedule::add(std::chrono::nanoseconds period, Function function) {
    const std::lock_guard lock(mutex_);
    Entry entry;
    entry.function = std::move(function);
    entry.start = Clock::now();
    entry.period = period;
    entries_.emplace(++lastKey_, std::move(entry));
    changed_.notify_all();
    return lastKey_;
}

void Schedule::remove(quint64 key) {
    const std::lock_guard lock(mutex_);
    entries_.erase(key);
}

void Schedule::run() {
    ::prctl(PR_SET_TIMERSLACK, 1UL); // nanosecond; an ordinary thread would wake up to 50 us late
    realtime_ = becomeRealtime(realtimePriority);
    std::unique_lock lock(mutex_);
    while (!ends_) {
        const auto next = nextTime();
        if (next == Clock::time_point::max())
            changed_.wait(lock);
        else
            changed_.wait_until(lock, next); // an absolute time of CLOCK_MONOTONIC
        if (!collect(Clock::now()) || posted_)
            continue;
        posted_ = true;
        QMetaObject::invokeMethod(
            this, [this] { callDue(); }, Qt::QueuedConnection);
    }
}

Schedule::Clock::time_point Schedule::nextTime() const {
    auto earliest = Clock::time_point::max();
    for (const auto &[key, entry] : entries_)
        earliest = std::min(earliest, entry.timeOf(entry.next));
    return earliest;
}

// Marks what is due; false when nothing is.
bool Schedule::collect(Clock::time_point now) {
    bool any = false;
    for (auto &[key, entry] : entries_) {
        if (now < entry.timeOf(entry.next))
            continue;
        any = true;
        const auto latest = quint64((now - entry.start) / entry.period);
        entry.missed += latest - entry.next + (entry.waits ? 1 : 0);
        entry.due = {latest, entry.timeOf(latest), entry.missed};
        entry.waits = true;
        entry.next = latest + 1;
    }
    return any;
}

void Schedule::callDue() {
    std::vector<std::pair<quint64, Due>> due;
    {
        const std::lock_guard lock(mutex_);
        posted_ = false;
        for (auto &[key, entry] : entries_) {
            if (!entry.waits)
                continue;
            due.emplace_back(key, entry.due);
            entry.waits = false;
            entry.missed = 0;
        }
    }
    std::sort(due.begin(), due.end(),
              [](const auto &a, const auto &b) { return a.second.time < b.second.time; });
    for (const auto &[key, one] : due) {
        Function function;
        {
            const std::lock_guard lock(mutex_);
            const auto found = entries_.find(key); // an earlier function may have removed it
            if (found != entries_.end())
                function = found->second.function;
        }
        if (function)
            function(one);
    }
}

} // namespace hermes::softwaretrigger
