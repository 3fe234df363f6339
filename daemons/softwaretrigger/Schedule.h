#pragma once

#include <QObject>
#include <QSocketNotifier>
#include <QTime>
#include <QtGlobal>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

namespace hermes::softwaretrigger {

/// When a daily time comes, by a wall clock that may be set at any moment. No I/O: told the time, in seconds
/// since the epoch. A time that a step forward jumps over, or that is noticed more than a second late, is
/// missed, not made up for; one that a step back of less than 12 hours brings again does not fire again.
class DayTime {
public:
    static constexpr double tolerance_s = 1;
    struct Verdict {
        bool fires = false;
        bool missed = false;
        double due = 0; ///< the time that was judged
    };

    DayTime(const QTime &at, bool utc, double now)
        : at_(at)
        , utc_(utc)
        , next_(firstAfter(now)) {}
    /// The next time, seconds since the epoch.
    double next() const { return next_; }
    /// To be asked at next(), and after each step of the clock.
    Verdict judge(double now);

private:
    double firstAfter(double stamp) const;

    QTime at_;
    bool utc_;
    double next_;
    double last_ = 0; // that fired
};

/// Calls a function at a time of each day, by the clock of the system, which tells when it is set.
class DayAlarm : public QObject {
    Q_OBJECT
public:
    using Function = std::function<void(const DayTime::Verdict &)>;

    DayAlarm(const DayTime &time, Function function);
    ~DayAlarm() override;

private:
    void arm();
    void awake();

    DayTime time_;
    Function function_;
    int descriptor_;
    std::unique_ptr<QSocketNotifier> notifier_;
};

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
    void remove(quint64 key) {
        const std::lock_guard lock(mutex_);
        entries_.erase(key);
    }
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
