#include "daemons/softwaretrigger/DayTime.h"

#include <QDateTime>
#include <cmath>

namespace hermes::softwaretrigger {

DayTime::DayTime(const QTime &at, bool utc, double now)
    : at_(at)
    , utc_(utc)
    , next_(firstAfter(now)) {}

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

} // namespace hermes::softwaretrigger
