#pragma once

#include "tests/daemons/MachineStalls.h"
#include "tests/support/ThreadTime.h"

#include <QElapsedTimer>
#include <QTimer>
#include <algorithm>

namespace hermes {

/// How long the event loop of this thread was busy with something else. Time on the clock holds what other
/// programs did meanwhile; time of the processor is the thread's own. A processor that stands still counts as
/// neither: the system takes such a time for work of the thread.
class LoopWatch {
public:
    LoopWatch() {
        timer_.setTimerType(Qt::PreciseTimer);
        QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] { beat(); });
        restart();
        timer_.start(period_ms);
    }
    void restart() {
        beat();
        longest_ms_ = longestCpu_ms_ = 0;
    }
    double longest_ms() {
        beat();
        return longest_ms_;
    }
    double longestCpu_ms() {
        beat();
        return longestCpu_ms_;
    }

private:
    static constexpr int period_ms = 2;

    void beat() {
        const double cpu = threadTime_ms(), stalled_ms = 1e3 * stalls_.takeLongest();
        if (clock_.isValid())
            longest_ms_ =
                std::max(longest_ms_, double(clock_.nsecsElapsed()) * 1e-6 - period_ms - stalled_ms);
        longestCpu_ms_ = std::max(longestCpu_ms_, cpu - cpu_ms_ - stalled_ms);
        clock_.start();
        cpu_ms_ = threadTime_ms();
    }

    MachineStalls stalls_;
    QTimer timer_;
    QElapsedTimer clock_;
    double longest_ms_ = 0, longestCpu_ms_ = 0, cpu_ms_ = 0;
};

} // namespace hermes
