#include "gui/desktop/view/PlotPane.h"

#include "gui/desktop/view/CurveLine.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QApplication>
#include <QContextMenuEvent>
#include <QHelpEvent>
#include <QToolTip>
#include <QWheelEvent>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr double wheelStep = 1.25, panStep = 0.1; // of the window

} // namespace

PlotPane::PlotPane(TimeWindow &time, QWidget *parent)
    : QWidget(parent)
    , time_(time) {
    setObjectName("pane");
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setMinimumSize(160, 56);
    setAttribute(Qt::WA_OpaquePaintEvent);
    connect(&time, &TimeWindow::cursorMoved, this, QOverload<>::of(&QWidget::update));
}

QFont PlotPane::smallFont() const {
    QFont small = font();
    small.setPointSizeF(0.85 * small.pointSizeF());
    return small;
}

void PlotPane::refresh() {
    fit(scene_.left, false);
    fit(scene_.right, true);
    update();
}

void PlotPane::fit(ValueAxis &axis, bool isRight) {
    if (!axis.isAutomatic())
        return;
    std::optional<std::pair<double, double>> all;
    for (const PlotLine &line : scene_.lines) {
        if (line.isRight != isRight)
            continue;
        const auto range = extremes(*line.samples, line.now + time_.left_s(), line.now + time_.right_s());
        if (range)
            all = all ? std::pair(std::min(all->first, range->first), std::max(all->second, range->second))
                      : range;
    }
    if (all)
        axis.fit(all->first, all->second);
}

void PlotPane::paintEvent(QPaintEvent *) {
    QPainter painter(this);
    this->painter(rect()).paint(painter);
    if (hasFocus()) {
        painter.setPen(QPen(palette().color(QPalette::Highlight), 1));
        painter.drawRect(rect().adjusted(0, 0, -1, -1));
    }
}

void PlotPane::zoomValues(double factor, double share) {
    scene_.left.zoom(factor, share);
    scene_.right.zoom(factor, share);
    update();
}

void PlotPane::wheelEvent(QWheelEvent *event) {
    event->accept();
    const QPoint turned = event->angleDelta(); // some systems turn it with Shift
    const double steps = (turned.y() != 0 ? turned.y() : turned.x()) / 120.0;
    const QRectF chart = painter(rect()).chart();
    const double factor = std::pow(wheelStep, steps);
    const QPointF share((event->position().x() - chart.left()) / chart.width(),
                        (chart.bottom() - event->position().y()) / chart.height());
    if (event->modifiers() & Qt::ShiftModifier)
        time_.pan(-steps * panStep * time_.span_s());
    else if (event->modifiers() & Qt::ControlModifier)
        zoomValues(factor, qBound(0.0, share.y(), 1.0));
    else
        time_.zoom(factor, qBound(0.0, share.x(), 1.0));
    pointAt(event->position());
}

void PlotPane::pointAt(const QPointF &place) {
    const QRectF chart = painter(rect()).chart();
    const double share = (place.x() - chart.left()) / chart.width();
    const bool isInside = share >= 0 && share <= 1;
    time_.setCursor(isInside ? std::make_optional(time_.left_s() + share * time_.span_s()) : std::nullopt);
}

void PlotPane::mousePressEvent(QMouseEvent *event) {
    Q_EMIT chosen();
    if (event->button() != Qt::LeftButton)
        return;
    dragged_ = event->localPos();
    isDragging_ = false;
}

void PlotPane::mouseMoveEvent(QMouseEvent *event) {
    const QRectF chart = painter(rect()).chart();
    const double seconds = time_.span_s() / chart.width();
    if (dragged_ && event->buttons() & Qt::LeftButton) {
        const QPointF way = event->localPos() - *dragged_;
        isDragging_ =
            isDragging_ || std::abs(way.x()) + std::abs(way.y()) >= QApplication::startDragDistance();
        if (!isDragging_)
            return;
        dragged_ = event->localPos();
        if (!scene_.left.isAutomatic()) {
            scene_.left.pan(way.y() / chart.height());
            scene_.right.pan(way.y() / chart.height());
        }
        if (time_.isHeld() || way.x() > 0) // on from now there is nothing
            time_.pan(-way.x() * seconds);
    }
    pointAt(event->localPos());
}

void PlotPane::keyPressEvent(QKeyEvent *event) {
    const bool isUp = event->key() == Qt::Key_PageUp;
    if (event->key() == Qt::Key_End)
        return Q_EMIT liveWanted();
    if (event->key() == Qt::Key_Home)
        return time_.goToBegin();
    if (!isUp && event->key() != Qt::Key_PageDown)
        return QWidget::keyPressEvent(event);
    if (event->modifiers() & Qt::ControlModifier)
        return zoomValues(isUp ? wheelStep : 1 / wheelStep, 0.5);
    if (isUp || time_.isHeld())
        time_.pan((isUp ? -1 : 1) * time_.span_s() / 2);
}

void PlotPane::focusInEvent(QFocusEvent *event) {
    QWidget::focusInEvent(event);
    Q_EMIT chosen();
}

void PlotPane::contextMenuEvent(QContextMenuEvent *event) {
    Q_EMIT chosen();
    Q_EMIT menuWanted(event->reason() == QContextMenuEvent::Mouse ? event->globalPos()
                                                                  : mapToGlobal(rect().center()));
}

QString PlotPane::toolTipAt(const QPoint &place) const {
    const PlotPainter shown = painter(rect());
    if (shown.chart().contains(place))
        return {}; // it would hide the curves
    QStringList names;
    for (const PlotLine &line : scene_.lines)
        names.append(shortLine(line.field.topic + ' ' + line.field.path) +
                     (line.unit.isEmpty() ? QString() : " (" + line.unit + ')'));
    if (shown.legend().contains(place) && !names.isEmpty())
        return names.join('\n');
    return tr("Wheel: the time that is shown\nShift and wheel, or drag: back in the last ten minutes\n"
              "Ctrl and wheel: the values that are shown\nDouble click: live again");
}

bool PlotPane::event(QEvent *event) {
    if (event->type() != QEvent::ToolTip)
        return QWidget::event(event);
    const auto *const help = static_cast<QHelpEvent *>(event);
    QToolTip::showText(help->globalPos(), toolTipOf(toolTipAt(help->pos())), this);
    return true;
}

} // namespace hermes::desktop
