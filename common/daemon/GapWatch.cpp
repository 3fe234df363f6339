#include "common/daemon/GapWatch.h"

#include "common/Time.h"

#include <algorithm>

namespace hermes {

GapWatch::GapWatch(QObject *parent)
    : QObject(parent) {
    pulse_.setTimerType(Qt::PreciseTimer);
    connect(&pulse_, &QTimer::timeout, this, [this] {
        look();
        Q_EMIT looked();
    });
}

void GapWatch::watch(double seconds) {
    look();
    longest_ = seconds;
    last_ = bootNow();
    if (longest_ > 0)
        pulse_.start(std::max(1, int(longest_ * 1000 / 8)));
    else
        pulse_.stop();
}

void GapWatch::look() {
    if (longest_ <= 0)
        return;
    const double now = bootNow();
    const double passed = now - last_;
    last_ = now;
    if (passed <= longest_)
        return;
    until_ = now;
    ++number_;
    words_ = QStringLiteral("this program stood still for %1 s").arg(passed, 0, 'f', 2);
    Q_EMIT ended(words_);
}

double GapWatch::sinceLast() const {
    return bootNow() - until_;
}

} // namespace hermes
