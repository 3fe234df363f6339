#include "gui/desktop/view/TimeWindow.h"

#include <algorithm>
#include <cmath>

namespace hermes::desktop {

void TimeWindow::setSpan(double span_s) {
    if (!std::isfinite(span_s))
        return;
    span_s_ = std::clamp(span_s, shortest_s, longest_s);
    pan(0);
    Q_EMIT changed();
}

void TimeWindow::zoom(double factor, double share) {
    const double fixed = left_s() + share * span_s_;
    span_s_ = std::clamp(span_s_ / factor, shortest_s, longest_s);
    if (isHeld_)
        right_s_ = std::min(0.0, fixed + (1 - share) * span_s_);
    pan(0);
    Q_EMIT changed();
}

void TimeWindow::pan(double seconds) {
    right_s_ += seconds;
    if (right_s_ > 0)
        return setHeld(false);
    if (right_s_ < 0)
        isHeld_ = true;
    right_s_ = std::max(right_s_, std::min(0.0, span_s_ - longest_s));
    Q_EMIT changed();
}

void TimeWindow::setHeld(bool isHeld) {
    isHeld_ = isHeld;
    if (!isHeld)
        right_s_ = 0;
    Q_EMIT changed();
}

void TimeWindow::setCursor(const std::optional<double> &time_s) {
    if (cursor_s_ == time_s)
        return;
    cursor_s_ = time_s;
    Q_EMIT cursorMoved();
}

QString spanText(double span_s) {
    if (span_s < 10)
        return QObject::tr("%1 s").arg(span_s, 0, 'g', 2);
    const int whole = int(std::lround(span_s));
    if (whole < 60)
        return QObject::tr("%1 s").arg(whole);
    return whole % 60 == 0 ? QObject::tr("%1 min").arg(whole / 60)
                           : QObject::tr("%1 min %2 s").arg(whole / 60).arg(whole % 60);
}

} // namespace hermes::desktop
