#include "daemons/softwaretrigger/Schedule.h"
#include "common/Log.h"
#include "common/Realtime.h"
#include "common/Time.h"

#include <QDateTime>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <sys/prctl.h>
#include <sys/timerfd.h>
#include <unistd.h>
#include <vector>

namespace hermes::softwaretrigger {

DayTime::Verdict DayTime::judge(double now) {
    Verdict verdict;
    verdict.due = next_;
    if (now >= next_) {
        verdict.fires = now - next_ <= tolerance_s;
        verdict.missed = !verdict.fires;
        if (verdict.fires)
            last_ = next_;
    }
    const bool alreadyFired = last_ > now && last_ - now < 12 * 3600;
    next_ = firstAfter(alreadyFired ? last_ : now);
    return verdict;
}

double DayTime::firstAfter(double stamp) const {
    const Qt::TimeSpec zone = utc_ ? Qt::UTC : Qt::LocalTime;
    const QDate today = QDateTime::fromMSecsSinceEpoch(qint64(std::floor(stamp * 1000)), zone).date();
    for (int day = 0;; ++day) {
        const double time = double(QDateTime(today.addDays(day), at_, zone).toMSecsSinceEpoch()) / 1000;
        if (time > stamp)
            return time;
    }
}

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
