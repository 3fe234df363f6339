#include "gui/desktop/view/PlotPainter.h"

#include "gui/desktop/Theme.h"

#include <QFontMetricsF>
#include <array>
#include <cmath>

namespace hermes::desktop {
namespace {

QString timeText(double time_s, double step_s) {
    return QObject::tr("%1 s").arg(time_s, 0, 'f', step_s < 1 ? 1 : 0);
}

} // namespace

PlotPainter::PlotPainter(const PlotScene &scene, const TimeWindow &time, const QRectF &place,
                         const QFont &font, const QPalette &palette)
    : scene_(scene)
    , time_(time)
    , place_(place)
    , font_(font)
    , palette_(palette)
    , lineHeight_(QFontMetricsF(font).height()) {
    const double axis = QFontMetricsF(font).horizontalAdvance("-0.0000") + 8;
    const double legend = std::min(0.4 * place.width(), scene.legendWidth);
    const double below = scene.hasTimeAxis ? lineHeight_ + 6 : 4;
    legend_ = place.adjusted(place.width() - legend, 2, -4, -2);
    chart_ = place.adjusted(axis, 4, -legend - (scene.hasRightAxis ? axis : 8), -below);
}

double PlotPainter::legendWidth(const std::vector<PlotLine> &lines, const QFont &font) {
    double names = 0;
    for (const PlotLine &line : lines)
        names = std::max(names, QFontMetricsF(font).horizontalAdvance(line.name));
    return names + QFontMetricsF(font).horizontalAdvance("-0.000000 rad/s") + 40;
}

void PlotPainter::paint(QPainter &painter) const {
    painter.save();
    painter.setFont(font_);
    painter.fillRect(place_, palette_.color(QPalette::Base));
    if (scene_.isChosen)
        painter.fillRect(QRectF(place_.left(), place_.top(), 3, place_.height()),
                         palette_.color(QPalette::Highlight));
    paintGrid(painter);
    paintValues(painter, scene_.left, false);
    if (std::any_of(scene_.lines.begin(), scene_.lines.end(), [](const auto &line) { return line.isRight; }))
        paintValues(painter, scene_.right, true);
    if (scene_.hasTimeAxis)
        paintTimes(painter);
    paintCurves(painter);
    paintCursor(painter);
    paintLegend(painter);
    painter.restore();
}

int PlotPainter::valueTicks() const {
    const double lines = chart_.height() / lineHeight_;
    return std::clamp(int(lines / 1.8), std::clamp(int(lines / 1.1), 1, 3), 6);
}

void PlotPainter::paintGrid(QPainter &painter) const {
    const QColor base = palette_.color(QPalette::Base), text = palette_.color(QPalette::Text);
    painter.setPen(QPen(theme::mixed(base, text, 0.12), 1));
    const ChartFrame frame{chart_, 0, 1, scene_.left.least(), scene_.left.most()};
    for (const Tick &tick : ticks(scene_.left.least(), scene_.left.most(), valueTicks()))
        painter.drawLine(QLineF(chart_.left(), frame.y(tick.value), chart_.right(), frame.y(tick.value))
                             .translated(0, 0.5));
    for (const Tick &tick : ticks(time_.left_s(), time_.right_s(), 6))
        painter.drawLine(QLineF(xAt(tick.value), chart_.top(), xAt(tick.value), chart_.bottom()));
    painter.setPen(QPen(theme::mixed(base, text, 0.35), 1));
    painter.drawRect(chart_);
}

void PlotPainter::paintValues(QPainter &painter, const ValueAxis &axis, bool isRight) const {
    const ChartFrame frame{chart_, 0, 1, axis.least(), axis.most()};
    const double edge = isRight ? chart_.right() + 4 : place_.left() + 4;
    const double width = isRight ? legend_.left() - edge : chart_.left() - 4 - edge;
    painter.setPen(palette_.color(QPalette::Text));
    for (const Tick &tick : ticks(axis.least(), axis.most(), valueTicks())) {
        const double top =
            qBound(place_.top(), frame.y(tick.value) - lineHeight_ / 2, place_.bottom() - lineHeight_);
        painter.drawText(QRectF(edge, top, width, lineHeight_),
                         (isRight ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter, tick.text);
    }
    painter.setPen(palette_.color(QPalette::Disabled, QPalette::Text));
    painter.drawText(chart_.adjusted(4, 1, -4, -1), Qt::AlignTop | (isRight ? Qt::AlignRight : Qt::AlignLeft),
                     unitsOf(isRight));
}

QString PlotPainter::unitsOf(bool isRight) const {
    QStringList units;
    for (const PlotLine &line : scene_.lines)
        if (line.isRight == isRight && !line.unit.isEmpty() && !units.contains(line.unit))
            units.append(line.unit);
    return units.join(", ");
}

void PlotPainter::paintTimes(QPainter &painter) const {
    const int most = std::max(2, int(chart_.width() / (8 * QFontMetricsF(font_).averageCharWidth() + 20)));
    const std::vector<Tick> times = ticks(time_.left_s(), time_.right_s(), std::min(most, 6));
    painter.setPen(palette_.color(QPalette::Text));
    const double step_s = times.size() < 2 ? 1 : times[1].value - times[0].value;
    for (const Tick &tick : times) {
        const QString text = timeText(tick.value, step_s);
        const double width = QFontMetricsF(font_).horizontalAdvance(text) + 4;
        const double left = qBound(place_.left(), xAt(tick.value) - width / 2, legend_.left() - width);
        const QRectF box(left, chart_.bottom() + 3, width, lineHeight_);
        if (!isCursorSeen() || !box.intersects(cursorBox()))
            painter.drawText(box, Qt::AlignCenter, text);
    }
}

// Lines that go up and down in one column of pixels gain nothing from smooth edges, and take long.
void PlotPainter::paintCurves(QPainter &painter) const {
    painter.save();
    painter.setClipRect(chart_);
    for (const PlotLine &line : scene_.lines) {
        painter.setPen(QPen(line.pen.color(), 0, line.pen.style())); // 0: one pixel, the fastest
        int points = 0;
        const QVector<QPolygonF> lines = curveLines(*line.samples, frameOf(line));
        for (const QPolygonF &part : lines)
            points += part.size();
        const bool isSparse = points < chart_.width();
        painter.setRenderHint(QPainter::Antialiasing, isSparse);
        if (isSparse)
            painter.setPen(line.pen);
        for (const QPolygonF &part : lines)
            painter.drawPolyline(part);
        painter.setPen(QPen(line.pen.color(), 4, Qt::SolidLine, Qt::RoundCap));
        for (const QPolygonF &part : lines)
            if (points < chart_.width() / 12 || part.size() == 1)
                painter.drawPoints(part);
    }
    painter.restore();
}

ChartFrame PlotPainter::frameOf(const PlotLine &line) const {
    const ValueAxis &axis = line.isRight ? scene_.right : scene_.left;
    return {chart_, line.now + time_.left_s(), line.now + time_.right_s(), axis.least(), axis.most()};
}

bool PlotPainter::isCursorSeen() const {
    return time_.cursor_s() && *time_.cursor_s() >= time_.left_s() && *time_.cursor_s() <= time_.right_s();
}

QRectF PlotPainter::cursorBox() const {
    const double width = QFontMetricsF(font_).horizontalAdvance(scene_.cursorTime) + 10;
    const double left = qBound(chart_.left(), xAt(*time_.cursor_s()) - width / 2,
                               std::max(chart_.left(), chart_.right() - width));
    return {left, chart_.bottom() + 2, width, lineHeight_ + 2};
}

void PlotPainter::paintCursor(QPainter &painter) const {
    if (!isCursorSeen())
        return;
    const double x = xAt(*time_.cursor_s());
    painter.setPen(QPen(palette_.color(QPalette::Text), 1, Qt::DashLine));
    painter.drawLine(QLineF(x, chart_.top(), x, chart_.bottom()));
    for (const PlotLine &line : scene_.lines) {
        const auto sample = sampleShown(line);
        if (!sample)
            continue;
        const ChartFrame frame = frameOf(line);
        const QPointF point(frame.x(sample->x()), frame.y(sample->y()));
        painter.setPen(QPen(line.pen.color(), 6, Qt::SolidLine, Qt::RoundCap));
        if (chart_.contains(point))
            painter.drawPoint(point);
    }
    if (!scene_.hasTimeAxis)
        return;
    const QRectF box = cursorBox();
    painter.fillRect(box, palette_.color(QPalette::Highlight));
    painter.setPen(palette_.color(QPalette::HighlightedText));
    painter.drawText(box, Qt::AlignCenter, scene_.cursorTime);
}

std::optional<QPointF> PlotPainter::sampleShown(const PlotLine &line) const {
    const double time_s = time_.cursor_s().value_or(time_.right_s());
    if (!time_.cursor_s() && !time_.isHeld())
        return line.samples->empty() ? std::nullopt : std::make_optional(line.samples->back());
    return nearest(*line.samples, line.now + time_s, time_.span_s());
}

QString PlotPainter::valueText(const PlotLine &line) const {
    if (!line.silence.isEmpty() && !time_.cursor_s() && !time_.isHeld())
        return line.silence;
    const auto sample = sampleShown(line);
    if (!sample)
        return QStringLiteral("–");
    const QString value = desktop::valueText(sample->y());
    return line.unit.isEmpty() ? value : value + ' ' + line.unit;
}

int PlotPainter::shownNames() const {
    const int room = std::max(1, int(legend_.height() / lineHeight_)), all = int(scene_.lines.size());
    return all <= room ? all : room - 1; // the last line says how many there are more
}

void PlotPainter::paintLegend(QPainter &painter) const {
    const QFontMetricsF metrics(font_);
    const QColor text = palette_.color(QPalette::Text),
                 grey = palette_.color(QPalette::Disabled, QPalette::Text);
    QRectF row(legend_.left() + 6, legend_.top(), legend_.width() - 6, lineHeight_);
    const int shown = shownNames();
    for (int i = 0; i < shown; ++i, row.translate(0, lineHeight_)) {
        const PlotLine &line = scene_.lines[std::size_t(i)];
        painter.setPen(QPen(line.pen.color(), 2, line.pen.style()));
        painter.drawLine(QLineF(row.left(), row.center().y(), row.left() + 16, row.center().y()));
        const bool isLive = !line.isOld || time_.cursor_s() || time_.isHeld();
        painter.setPen(isLive ? text : grey);
        const QString value = valueText(line);
        const double width = std::min(metrics.horizontalAdvance(value) + 6, 0.6 * row.width());
        const QRectF names = row.adjusted(22, 0, -width, 0);
        painter.drawText(names, Qt::AlignVCenter,
                         metrics.elidedText(line.name, Qt::ElideMiddle, names.width()));
        painter.drawText(row, Qt::AlignVCenter | Qt::AlignRight,
                         metrics.elidedText(value, Qt::ElideRight, width));
    }
    if (shown < int(scene_.lines.size())) {
        painter.setPen(grey);
        painter.drawText(row, Qt::AlignVCenter,
                         QObject::tr("and %1 more").arg(int(scene_.lines.size()) - shown));
    }
}

QString valueText(double value) {
    const double size = std::abs(value);
    if (value == std::floor(value) && size < 1e9)
        return QString::number(value, 'f', 0);
    if (size >= 1e6 || size < 0.001)
        return QString::number(value, 'g', 3);
    return QString::number(value, 'f', size < 10 ? 3 : size < 1000 ? 2 : 1);
}

// Those of Okabe and Ito, which the colour-blind tell apart, where they are seen on the background.
QPen curvePen(int number) {
    static const std::array<QRgb, 6> light{0x005fa8, 0xc44e00, 0x00805a, 0xa83f7c, 0x6b5b00, 0x338fc4};
    static const std::array<QRgb, 6> dark{0x56b4e9, 0xf09a40, 0x2fc495, 0xe08fbf, 0xf0e442, 0xa8b8ff};
    static const std::array<Qt::PenStyle, 3> styles{Qt::SolidLine, Qt::DashLine, Qt::DotLine};
    const auto &colours = theme::isDark() ? dark : light;
    return QPen(QColor(colours[std::size_t(number) % colours.size()]), 1.5,
                styles[std::size_t(number) / colours.size() % styles.size()]);
}

} // namespace hermes::desktop
