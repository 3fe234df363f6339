#pragma once

#include <QObject>
#include <QSocketNotifier>
#include <chrono>
#include <functional>
#include <memory>

namespace hermes::motorcontrol {

/// How punctual the cycle was, over its last window.
struct CycleStatistics {
    quint64 cycles = 0;        ///< since the start
    quint64 missed = 0;        ///< periods without a cycle, since the start: the thread came too late
    double meanLateness_s = 0; ///< of the begin of a cycle, after its time
    double worstLateness_s = 0;
};

/// Calls a function at equal intervals, on an absolute grid of time: delays do not add up. Lives in the
/// thread that runs its event loop.
class CycleTimer : public QObject {
public:
    static constexpr int window = 50; ///< cycles that statistics() covers

    CycleTimer(std::function<void()> cycle, QObject *parent);
    ~CycleTimer() override;

    /// False, with errno, when the system gives no timer.
    bool start(std::chrono::nanoseconds period);
    void stop();
    bool isRunning() const { return descriptor_ >= 0; }
    const CycleStatistics &statistics() const { return statistics_; }

private:
    void tick();

    std::function<void()> cycle_;
    int descriptor_ = -1;
    std::unique_ptr<QSocketNotifier> notifier_;
    std::chrono::nanoseconds period_{};
    std::chrono::steady_clock::time_point next_; // when the next cycle shall begin
    CycleStatistics statistics_;
    int inWindow_ = 0;
    double latenessSum_ = 0, latenessMax_ = 0;
};

} // namespace hermes::motorcontrol
