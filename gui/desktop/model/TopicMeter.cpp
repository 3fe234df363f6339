#include "gui/desktop/model/TopicMeter.h"

#include "common/Time.h"
#include "gui/desktop/widgets/Quantities.h"

#include <utility>

namespace hermes::desktop {

TopicMeter::TopicMeter(DaemonLink *daemon, const QString &topic, double maxRate_hz, Client::TopicCallback see)
    : daemon_(daemon)
    , subscription_(daemon->subscribe(topic, {{"max_rate_hz", maxRate_hz}},
                                      [this](const TopicUpdate &update) { take(update); }))
    , see_(std::move(see)) {}

void TopicMeter::take(const TopicUpdate &update) {
    constexpr double least_s = 0.9; // that a rate is measured over
    freshness_.heard(daemon_);
    const double now = monotonicNow();
    if (since_ == 0 || update.seq < first_) { // the first, or of a daemon that was started again
        since_ = now;
        first_ = update.seq;
    } else if (now - since_ >= least_s) {
        measured_hz_ = double(update.seq - first_) / (now - since_);
        since_ = now;
        first_ = update.seq;
    }
    see_(update); // may end this
}

QString TopicMeter::text() const {
    if (freshness_.state() == Freshness::State::None)
        return {};
    if (freshness_.state() == Freshness::State::Silent)
        return freshness_.text();
    const QString age = ageText(freshness_.age_s());
    return measured_hz_ < 0 ? age : QObject::tr("%1, %2").arg(rateText(measured_hz_), age);
}

QString rateText(double rate_hz) {
    return QObject::tr("%1 Hz").arg(rate_hz, 0, 'f', rate_hz < 9.95 ? 1 : 0);
}

QString ageText(double age_s) {
    return age_s < 60 ? QObject::tr("%1 s").arg(age_s, 0, 'f', 1) : durationText(age_s);
}

} // namespace hermes::desktop
