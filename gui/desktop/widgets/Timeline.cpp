#include "gui/desktop/widgets/Timeline.h"

#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QStyleOptionFocusRect>
#include <QToolTip>

#include <algorithm>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr int radius = 6, lineWidth = 4, margin = radius + 3, markHeight = 7; // pixels
constexpr int nearMark = 4;                                                   // pixels
constexpr int maxNamed = 5;
constexpr double beforeEnd_s = 0.2; // what is taken: at its very end the replay would be over

} // namespace

Timeline::Timeline(QWidget *parent)
    : QWidget(parent) {
    setFocusPolicy(Qt::TabFocus); // the mouse leaves the keys to the drive
    setAccessibleName(tr("Position in the replay"));
    setCursor(Qt::PointingHandCursor);
}

QSize Timeline::sizeHint() const {
    return {200, 2 * (radius + markHeight) + 4};
}

void Timeline::setDuration(double seconds) {
    duration_s_ = seconds > 0 && seconds <= longest_s ? seconds : 0;
    position_s_ = std::min(position_s_, duration_s_);
    update();
}

void Timeline::setPosition(double seconds) {
    if (isHeld_ || !(seconds >= 0))
        return;
    position_s_ = std::min(seconds, duration_s_);
    update();
}

void Timeline::setMarks(std::vector<Mark> marks) {
    marks_ = std::move(marks);
    update();
}

QPoint Timeline::pointOf(double seconds) const {
    const double share = duration_s_ > 0 ? std::clamp(seconds / duration_s_, 0.0, 1.0) : 0;
    return {margin + int(std::lround(share * (width() - 2 * margin))), height() / 2};
}

double Timeline::timeAt(int x) const {
    const double share = double(x - margin) / std::max(1, width() - 2 * margin);
    return std::clamp(share, 0.0, 1.0) * duration_s_;
}

void Timeline::paintEvent(QPaintEvent *) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QPalette::ColorGroup group = isEnabled() ? QPalette::Active : QPalette::Disabled;
    const QColor text = palette().color(group, QPalette::WindowText);
    const QColor played = isEnabled() ? palette().color(QPalette::Highlight) : text;
    QColor groove = text;
    groove.setAlpha(70);
    const QPoint begin = pointOf(0), here = pointOf(position_s_);
    const QPoint end(width() - margin, begin.y());
    painter.setPen(QPen(groove, lineWidth, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(begin, end);
    painter.setPen(QPen(played, lineWidth, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(begin, here);
    painter.setPen(Qt::NoPen);
    painter.setBrush(text);
    for (const Mark &mark : marks_)
        if (mark.t_s >= 0 && mark.t_s <= duration_s_) { // a flag that points at the line
            const QPoint foot = pointOf(mark.t_s) - QPoint(0, lineWidth / 2 + 1);
            painter.drawPolygon(
                QPolygon({foot, foot + QPoint(-4, -markHeight), foot + QPoint(4, -markHeight)}));
        }
    painter.setPen(QPen(palette().color(QPalette::Window), 1.5));
    painter.setBrush(played);
    if (duration_s_ > 0)
        painter.drawEllipse(here, radius, radius);
    if (!hasFocus())
        return;
    QStyleOptionFocusRect frame;
    frame.initFrom(this);
    style()->drawPrimitive(QStyle::PE_FrameFocusRect, &frame, &painter, this);
}

/// The time there, and the marks that stand there.
QString Timeline::textAt(int x) const {
    if (duration_s_ <= 0)
        return toolTip();
    QStringList lines{durationText(timeAt(x))};
    for (const Mark &mark : marks_)
        if (mark.t_s <= duration_s_ && std::abs(pointOf(mark.t_s).x() - x) <= nearMark) {
            if (lines.size() > maxNamed) {
                lines.append(tr("and more"));
                break;
            }
            lines.append(tr("%1 at %2").arg(shortLine(mark.text, longestName), durationText(mark.t_s)));
        }
    return toolTipOf(lines.join('\n'));
}

bool Timeline::event(QEvent *event) {
    if (event->type() != QEvent::ToolTip)
        return QWidget::event(event);
    const auto *const help = static_cast<QHelpEvent *>(event);
    QToolTip::showText(help->globalPos(), textAt(help->pos().x()), this);
    return true;
}

void Timeline::take(double seconds) {
    const double last_s = std::max(0.0, duration_s_ - beforeEnd_s);
    position_s_ = std::clamp(seconds, 0.0, last_s);
    update();
    Q_EMIT sought(position_s_);
}

void Timeline::mousePressEvent(QMouseEvent *event) {
    if (event->button() != Qt::LeftButton || duration_s_ <= 0)
        return;
    isHeld_ = true;
    Q_EMIT heldChanged(true);
    take(timeAt(event->x()));
}

void Timeline::mouseMoveEvent(QMouseEvent *event) {
    if (isHeld_)
        take(timeAt(event->x()));
}

void Timeline::mouseReleaseEvent(QMouseEvent *event) {
    if (event->button() == Qt::LeftButton)
        letGo();
}

void Timeline::letGo() {
    if (std::exchange(isHeld_, false))
        Q_EMIT heldChanged(false);
}

/// What it shows has ended, whatever the mouse does.
void Timeline::hideEvent(QHideEvent *) {
    letGo();
}

void Timeline::keyPressEvent(QKeyEvent *event) {
    const int key = event->key();
    if (duration_s_ <= 0 || (key != Qt::Key_PageUp && key != Qt::Key_PageDown && key != Qt::Key_Home))
        return QWidget::keyPressEvent(event);
    take(key == Qt::Key_Home ? 0 : position_s_ + (key == Qt::Key_PageDown ? step_s : -step_s));
}

} // namespace hermes::desktop
