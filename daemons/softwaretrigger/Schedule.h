#pragma once

#include <QObject>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace hermes::softwaretrigger {

/// Calls functions at t0 + n T, for any number of periods at a time. A thread of its own waits for absolute
/// times of the monotonic clock, so that delays do not add up and steps of the wall clock do not matter. What
/// comes due while an earlier call of the same period still waits, or after an interruption, is counted as
/// missed: there is one call, for the latest, and never a burst. Use from one thread with an event
/// loop, in which the functions are called.
class Schedule : public QObject {
    Q_OBJECT
public:
    using Clock = std::chrono::steady_clock; // CLOCK_MONOTONIC
    struct Due {
        quint64 n = 0; ///< which, from 1
        Clock::time_point time;
        quint64 missed = 0; ///< before it, since the last call
    };
    using Function = std::function<void(const Due &)>;
    static constexpr int realtimePriority = 10; ///< below the motors'

    Schedule();
    ~Schedule() override;

    /// t0 is now. Gives a key for remove().
    quint64 add(std::chrono::nanoseconds period, Function function);
    void remove(quint64 key);
    /// Whether the thread runs before all ordinary ones; false also before it has begun.
    bool isRealtime() const { return realtime_; }

private:
    struct Entry {
        Function function;
        Clock::time_point start;
        std::chrono::nanoseconds period;
        quint64 next = 1; // not due yet
        Due due;
        bool waits = false; // due has not been called yet
        quint64 missed = 0; // before due

        Clock::time_point timeOf(quint64 n) const {
            return start + period * std::chrono::nanoseconds::rep(n);
        }
    };

    void run();
    Clock::time_point nextTime() const;
    bool collect(Clock::time_point now);
    void callDue();

    std::mutex mutex_; // of all below
    std::condition_variable changed_;
    std::map<quint64, Entry> entries_;
    quint64 lastKey_ = 0;
    bool ends_ = false;
    bool posted_ = false; // callDue() is on its way
    std::atomic<bool> realtime_{false};
    std::thread thread_;
};

} // namespace hermes::softwaretrigger
