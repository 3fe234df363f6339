#include "daemons/softwaretrigger/DayAlarm.h"

#include "common/Log.h"
#include "common/Time.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <sys/timerfd.h>
#include <unistd.h>

namespace hermes::softwaretrigger {

DayAlarm::DayAlarm(const DayTime &time, Function function)
    : time_(time)
    , function_(std::move(function))
    , descriptor_(::timerfd_create(CLOCK_REALTIME, TFD_NONBLOCK | TFD_CLOEXEC)) {
    if (descriptor_ < 0) {
        logError("time of day", QString("the system gives no timer: ") + std::strerror(errno));
        return;
    }
    notifier_ = std::make_unique<QSocketNotifier>(descriptor_, QSocketNotifier::Read);
    connect(notifier_.get(), &QSocketNotifier::activated, this, &DayAlarm::awake);
    arm();
}

DayAlarm::~DayAlarm() {
    notifier_.reset();
    if (descriptor_ >= 0)
        ::close(descriptor_);
}

void DayAlarm::arm() {
    itimerspec when{};
    when.it_value.tv_sec = time_t(std::floor(time_.next()));
    when.it_value.tv_nsec = long((time_.next() - std::floor(time_.next())) * 1e9);
    // A step of the clock makes the descriptor readable, and the read fail with ECANCELED.
    ::timerfd_settime(descriptor_, TFD_TIMER_ABSTIME | TFD_TIMER_CANCEL_ON_SET, &when, nullptr);
}

void DayAlarm::awake() {
    quint64 count = 0;
    const bool due = ::read(descriptor_, &count, sizeof count) == sizeof count;
    if (!due && errno != ECANCELED)
        return;
    const auto verdict = time_.judge(stampNow());
    arm();
    if (verdict.fires || verdict.missed)
        function_(verdict);
}

} // namespace hermes::softwaretrigger
