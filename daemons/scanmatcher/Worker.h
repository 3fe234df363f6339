#pragma once

#include "daemons/scanmatcher/MatcherMessages.h"
#include "vectorlib/mapping/ScanTracker.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace hermes::scanmatcher {

/// The thread that owns the tracker. Scans wait in a bounded queue that drops its oldest and counts; jobs
/// (settings, commands) are never dropped and run in order with the scans.
class Worker {
public:
    using Job = std::function<void(vectorlib::ScanTracker &)>;
    /// Called in the worker's thread after each scan; the scan has its motion compensated.
    using Done = std::function<void(vectorlib::ScanTracker &, const Scan &)>;

    explicit Worker(Done done)
        : whenDone_(std::move(done))
        , thread_([this] { run(); }) {}
    ~Worker() { stop(); }
    /// Finishes what waits, then ends the thread.
    void stop();

    /// In its thread: the tracker that takes what comes from now on, and the one that did so.
    std::unique_ptr<vectorlib::ScanTracker> exchange(std::unique_ptr<vectorlib::ScanTracker> other) {
        tracker_.swap(other);
        return other;
    }
    vectorlib::ScanTracker &tracker() { return *tracker_; }

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

    Done whenDone_;
    std::unique_ptr<vectorlib::ScanTracker> tracker_ =
        std::make_unique<vectorlib::ScanTracker>(); // used by the thread alone
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
