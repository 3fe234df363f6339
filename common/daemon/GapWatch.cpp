#include "common/daemon/GapWatch.h"

#include "common/Time.h"

#include <algorithm>

namespace hermes {

GapWatch::GapWatch(QObject *parent)
    : QObject(parent) {
    pulse.setTimerType(Qt::PreciseTimer);
    connect(&pulse, &QTimer::timeout, this, [this] {
        look();
        Q_EMIT looked();
    });
}

void GapWatch::watch(double seconds) {
    look();
    longest = seconds;
    last = bootNow();
    if (longest > 0)
        pulse.start(std::max(1, int(longest * 1000 / 8)));
    else
        pulse.stop();
}

void GapWatch::look() {
    if (longest <= 0)
        return;
    const double now = bootNow();
    const double passed = now - last;
    last = now;
    if (passed <= longest)
        return;
    until = now;
    ++number;
    words = QStringLiteral("this program stood still for %1 s").arg(passed, 0, 'f', 2);
    Q_EMIT ended(words);
}

double GapWatch::sinceLast() const {
    return bootNow() - until;
}

} // namespace hermes
