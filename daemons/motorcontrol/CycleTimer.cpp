#include "daemons/motorcontrol/CycleTimer.h"

#include <algorithm>
#include <sys/timerfd.h>
#include <unistd.h>

namespace hermes::motorcontrol {
namespace {

using Clock = std::chrono::steady_clock; // CLOCK_MONOTONIC

timespec toTimespec(std::chrono::nanoseconds time) {
    return {time_t(time.count() / 1000000000), long(time.count() % 1000000000)};
}

} // namespace

CycleTimer::CycleTimer(std::function<void()> cycle, QObject *parent)
    : QObject(parent)
    , cycle_(std::move(cycle)) {}

CycleTimer::~CycleTimer() {
    stop();
}

bool CycleTimer::start(std::chrono::nanoseconds period) {
    stop();
    descriptor_ = ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
    if (descriptor_ < 0)
        return false;
    period_ = period;
    next_ = Clock::now() + period;
    const itimerspec grid{toTimespec(period), toTimespec(next_.time_since_epoch())};
    if (::timerfd_settime(descriptor_, TFD_TIMER_ABSTIME, &grid, nullptr) != 0)
        return false;
    notifier_ = std::make_unique<QSocketNotifier>(descriptor_, QSocketNotifier::Read);
    connect(notifier_.get(), &QSocketNotifier::activated, this, &CycleTimer::tick);
    return true;
}

void CycleTimer::stop() {
    notifier_.reset();
    if (descriptor_ >= 0)
        ::close(descriptor_);
    descriptor_ = -1;
}

void CycleTimer::tick() {
    quint64 periods = 0;
    if (::read(descriptor_, &periods, sizeof(periods)) != sizeof(periods) || periods == 0)
        return;
    next_ += period_ * (periods - 1);
    const double late = std::chrono::duration<double>(Clock::now() - next_).count();
    next_ += period_;
    ++statistics_.cycles;
    statistics_.missed += periods - 1;
    latenessSum_ += late;
    latenessMax_ =
        std::max(latenessMax_, late + double(periods - 1) * std::chrono::duration<double>(period_).count());
    if (++inWindow_ == window) {
        statistics_.meanLateness_s = latenessSum_ / window;
        statistics_.worstLateness_s = latenessMax_;
        latenessSum_ = latenessMax_ = 0;
        inWindow_ = 0;
    }
    cycle_();
}

} // namespace hermes::motorcontrol
