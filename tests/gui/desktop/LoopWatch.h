#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <ctime>

namespace hermes {

/// How long the event loop of this thread was busy with something else. Time on the clock holds what the
/// machine did meanwhile; time of the processor is the thread's own.
class LoopWatch {
public:
    LoopWatch() {
        timer_.setTimerType(Qt::PreciseTimer);
        QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] { beat(); });
        restart();
        timer_.start(period_ms);
    }
    void restart() {
        longest_ms_ = longestCpu_ms_ = 0;
        clock_.start();
        cpu_ms_ = cpuNow_ms();
    }
    double longest_ms() const { return longest_ms_; }
    double longestCpu_ms() const { return longestCpu_ms_; }

private:
    static constexpr int period_ms = 2;

    static double cpuNow_ms() {
        timespec now{};
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
    }
    void beat() {
        const double cpu = cpuNow_ms();
        longest_ms_ = std::max(longest_ms_, double(clock_.nsecsElapsed()) * 1e-6 - period_ms);
        longestCpu_ms_ = std::max(longestCpu_ms_, cpu - cpu_ms_);
        clock_.start();
        cpu_ms_ = cpuNow_ms();
    }

    QTimer timer_;
    QElapsedTimer clock_;
    double longest_ms_ = 0, longestCpu_ms_ = 0, cpu_ms_ = 0;
};

} // namespace hermes
