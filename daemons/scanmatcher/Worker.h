#pragma once

#include "daemons/scanmatcher/MatcherMessages.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace hermes::scanmatcher {

/// The thread that matches. Scans wait in a bounded queue that drops its oldest and counts; jobs
/// (settings, commands) are never dropped and run in order with the scans.
class Worker {
public:
    using Job = std::function<void()>;
    using Take = std::function<void(Scan &)>;

    /// `take` is called in its thread with each scan.
    explicit Worker(Take take)
        : take_(std::move(take))
        , thread_([this] { run(); }) {}
    ~Worker() { stop(); }
    /// Finishes what waits, then ends the thread.
    void stop();

    void push(Scan scan);
    void post(Job job);
    void setQueueLimit(size_t scans);
    quint64 dropped() const {
        const std::lock_guard lock(mutex_);
        return lost_;
    }
    size_t waiting() const {
        const std::lock_guard lock(mutex_);
        return scans_;
    }

private:
    struct Item {
        Scan scan;
        Job job; // when empty, the scan is meant
    };
    void run();

    const Take take_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Item> items_;
    size_t scans_ = 0; // among the items
    size_t limit_ = 50;
    quint64 lost_ = 0;
    bool ending_ = false;
    std::thread thread_;
};

} // namespace hermes::scanmatcher
