#include "gui/desktop/view/MapPainter.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/view/Clipping.h"

#include <QPainter>
#include <QPainterPath>
#include <QtMath>

namespace hermes::desktop {
namespace {

struct Colours {
    QColor background, grid, axis, map, accent, scan, correspondence, path, odometry, truth, robot, text;
};

Colours colours() {
    if (theme::isDark())
        return {QColor(0x17, 0x1a, 0x1c), QColor(0x2a, 0x2f, 0x33), QColor(0x45, 0x4c, 0x52),
                QColor(0xd5, 0xda, 0xde), QColor(0x4d, 0xc4, 0xff), QColor(0xc9, 0x8a, 0x2b),
                QColor(0x6d, 0x8b, 0x74), QColor(0x5a, 0xa9, 0xff), QColor(0xb8, 0x8c, 0xe0),
                QColor(0x8f, 0x98, 0x9f), QColor(0xff, 0x8a, 0x3d), QColor(0xc3, 0xc9, 0xce)};
    return {QColor(0xfc, 0xfc, 0xfb), QColor(0xe9, 0xea, 0xe8), QColor(0xc9, 0xcc, 0xc9),
            QColor(0x24, 0x29, 0x2e), QColor(0x00, 0x7d, 0xc5), QColor(0xb8, 0x5c, 0x00),
            QColor(0x86, 0xa8, 0x8c), QColor(0x0b, 0x63, 0xc4), QColor(0x8a, 0x4f, 0xbf),
            QColor(0x6a, 0x71, 0x78), QColor(0xd9, 0x53, 0x00), QColor(0x3b, 0x41, 0x47)};
}

constexpr double robotRadius_m = 0.3; // as large as it is drawn
/// One pixel lines are fast without smoothing; beyond so many lines nobody sees the difference.
constexpr int smoothUpTo = 2000;
/// Pixels of lines that are drawn smoothly, and at all: a picture is not to take longer than 50 ms.
constexpr double longestSmooth = 2e5, longestDrawn = 1e6;

} // namespace

double gridStep_m(double pixelsPerMetre) {
    const double wanted = 80 / pixelsPerMetre;
    const double decade = std::pow(10, std::floor(std::log10(wanted)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * decade >= wanted)
            return factor * decade;
    return 10 * decade;
}

void MapPainter::paint(QPainter &painter) const {
    const Colours c = colours();
    painter.fillRect(QRect({}, size_), c.background);
    if (layers_.grid)
        paintGrid(painter);
    int leftOut = 0;
    if (layers_.map)
        leftOut += paintLines(painter, onScreen(model_.edges()), c.map, 2);
    if (layers_.scan)
        paintScan(painter);
    if (layers_.correspondences)
        leftOut += paintCorrespondences(painter);
    if (layers_.segments)
        leftOut += paintLines(painter, onScreen(model_.segments()), c.accent, 2);
    if (layers_.paths) {
        paintPath(painter, model_.truthPath(), c.truth, Qt::DotLine);
        paintPath(painter, model_.odometryPath(), c.odometry, Qt::DashLine);
        paintPath(painter, model_.matchedPath(), c.path, Qt::SolidLine);
    }
    if (layers_.robot && model_.pose()) {
        paintUncertainty(painter);
        paintRobot(painter);
    }
    if (layers_.grid)
        paintScaleBar(painter, gridStep_m(scale()));
    if (model_.pose())
        paintMatch(painter);
    paintNotice(painter, leftOut);
}

void MapPainter::paintGrid(QPainter &painter) const {
    const Colours c = colours();
    const double step = gridStep_m(scale());
    const QRectF world = transform_.inverted().mapRect(QRectF(QPointF(), size_));
    painter.setRenderHint(QPainter::Antialiasing, false);
    const auto line = [&](double at, bool isVertical) {
        painter.setPen(QPen(std::abs(at) < step / 2 ? c.axis : c.grid, 0));
        painter.drawLine(transform_.map(isVertical ? QLineF(at, world.top(), at, world.bottom())
                                                   : QLineF(world.left(), at, world.right(), at)));
    };
    // Counted, for far away the next double may be more than a step off.
    const double left = std::ceil(world.left() / step), top = std::ceil(world.top() / step);
    for (int i = 0; i <= int(world.width() / step); ++i)
        line((left + i) * step, true);
    for (int i = 0; i <= int(world.height() / step); ++i)
        line((top + i) * step, false);
}

int MapPainter::paintLines(QPainter &painter, const QVector<QLineF> &lines, const QColor &colour,
                           double width) const {
    const QRectF seen = QRectF(QPointF(), size_).adjusted(-5, -5, 5, 5);
    QVector<QLineF> shown;
    shown.reserve(lines.size());
    double length = 0;
    int leftOut = 0;
    for (const QLineF &line : lines) {
        const auto part = clipped(line, seen);
        if (part && length < longestDrawn)
            shown.append(*part);
        leftOut += part && length >= longestDrawn;
        length += part ? part->length() : 0;
    }
    const bool isSmooth = shown.size() <= smoothUpTo && length <= longestSmooth;
    painter.setRenderHint(QPainter::Antialiasing, isSmooth);
    painter.setPen(QPen(colour, isSmooth ? width : 1));
    painter.drawLines(shown);
    return leftOut;
}

QVector<QLineF> MapPainter::onScreen(const QVector<QLineF> &lines) const {
    QVector<QLineF> mapped;
    mapped.reserve(lines.size());
    for (const QLineF &line : lines)
        mapped.append(transform_.map(line));
    return mapped;
}

void MapPainter::paintScan(QPainter &painter) const {
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(QPen(colours().scan, 2));
    painter.drawPoints(transform_.map(model_.scan()));
}

int MapPainter::paintCorrespondences(QPainter &painter) const {
    QVector<QLineF> arrows;
    for (const QLineF &pair : model_.correspondences()) {
        const QLineF line = transform_.map(pair);
        arrows.append(line);
        if (line.length() < 3)
            continue;
        QLineF head(line.p2(), line.p1());
        head.setLength(6);
        for (const double turn : {25.0, -50.0}) {
            head.setAngle(head.angle() + turn);
            arrows.append(head);
        }
    }
    return paintLines(painter, arrows, colours().correspondence, 1);
}

void MapPainter::paintPath(QPainter &painter, const QPolygonF &path, const QColor &colour,
                           Qt::PenStyle style) const {
    painter.setRenderHint(QPainter::Antialiasing, path.size() <= smoothUpTo);
    painter.setPen(QPen(colour, 1.5, style));
    painter.drawPolyline(recent(transform_.map(path), QRectF(QPointF(), size_), longestSmooth));
}

// The ellipse and the pie hold the pose with 95 %, and are drawn ten times their size: on a good day
// nobody could see them otherwise. The legend says so.
void MapPainter::paintUncertainty(QPainter &painter) const {
    if (!model_.covariance())
        return;
    constexpr double enlarged = 10, chi95 = 2.4477, normal95 = 1.96;
    const auto &c = *model_.covariance();
    const double mean = (c[0] + c[4]) / 2, root = std::hypot((c[0] - c[4]) / 2, c[1]);
    const auto axis = [&](double variance) { // no longer than anything that can be seen
        return qMin(chi95 * enlarged * std::sqrt(qMax(0.0, variance)) * scale(), 1e5);
    };
    QColor fill = colours().path;
    fill.setAlpha(50);
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing, true);
    painter.setPen(QPen(colours().path, 1));
    painter.setBrush(fill);
    painter.translate(transform_.map(QPointF(model_.pose()->x, model_.pose()->y)));
    const double spread = qMin(180.0, qRadiansToDegrees(normal95 * enlarged * std::sqrt(qMax(0.0, c[8]))));
    const double radius = 2.5 * robotRadius_m * scale(), heading = qRadiansToDegrees(model_.pose()->theta);
    painter.drawPie(QRectF(-radius, -radius, 2 * radius, 2 * radius), qRound(16 * (heading - spread)),
                    qRound(16 * 2 * spread));
    painter.rotate(-qRadiansToDegrees(std::atan2(2 * c[1], c[0] - c[4]) / 2));
    painter.drawEllipse(QPointF(), axis(mean + root), axis(mean - root));
    painter.restore();
}

void MapPainter::paintRobot(QPainter &painter) const {
    const Pose2D pose = *model_.pose();
    const double r = robotRadius_m;
    const auto at = [&](double x, double y) { return transform_.map(pose * QPointF(x, y)); };
    painter.setRenderHint(QPainter::Antialiasing, true);
    QColor fill = colours().robot;
    painter.setPen(QPen(fill, 2));
    fill.setAlpha(60);
    painter.setBrush(fill);
    painter.drawEllipse(at(0, 0), r * scale(), r * scale());
    painter.setBrush(colours().robot);
    painter.drawPolygon(QVector<QPointF>{at(r, 0), at(0.3 * r, 0.35 * r), at(0.3 * r, -0.35 * r)});
    painter.setBrush(Qt::NoBrush);
}

void MapPainter::paintScaleBar(QPainter &painter, double step_m) const {
    const double length = step_m * scale();
    const QPointF right(size_.width() - 12, size_.height() - 12), left = right - QPointF(length, 0);
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(QPen(colours().text, 2));
    painter.drawLine(left, right);
    for (const QPointF &end : {left, right})
        painter.drawLine(end - QPointF(0, 4), end);
    painter.drawText(QRectF(left - QPointF(20, 26), QSizeF(length + 40, 20)), Qt::AlignCenter,
                     step_m < 1 ? QObject::tr("%1 cm").arg(100 * step_m) : QObject::tr("%1 m").arg(step_m));
}

void MapPainter::paintNotice(QPainter &painter, int leftOut) const {
    QStringList lines;
    if (model_.ignored() > 0)
        lines.append(QObject::tr("%1 impossible values are not shown").arg(model_.ignored()));
    if (leftOut > 0)
        lines.append(QObject::tr("%1 more lines are not drawn").arg(leftOut));
    painter.setPen(theme::colour(Condition::Warning));
    painter.drawText(QRectF(12, 0, size_.width() / 2.0, size_.height() - 12), Qt::AlignLeft | Qt::AlignBottom,
                     lines.join('\n'));
}

// How far to trust the pose: numbers with a bar whose colour and length say the same.
void MapPainter::paintMatch(QPainter &painter) const {
    const bool isLost = model_.outcome() == "lost";
    const double reliability = qBound(0.0, model_.reliability(), 1.0);
    const Condition condition = isLost              ? Condition::Fault
                                : reliability < 0.1 ? Condition::Warning
                                                    : Condition::Ready;
    const QStringList lines{
        QObject::tr("%1, reliability %2").arg(model_.outcome()).arg(reliability, 0, 'f', 2),
        QObject::tr("ambiguity %1 m²").arg(model_.ambiguity(), 0, 'g', 2)};
    const QFontMetrics metrics(painter.font());
    const int height = metrics.height();
    const QRectF box(12, 12, metrics.horizontalAdvance(lines[0]) + 24, 2 * height + 24);
    QColor back = colours().background;
    back.setAlpha(220);
    painter.setRenderHint(QPainter::Antialiasing, true);
    painter.setPen(QPen(colours().grid, 1));
    painter.setBrush(back);
    painter.drawRoundedRect(box, 4, 4);
    const QRectF bar = QRectF(box.left() + 8, box.bottom() - 14, box.width() - 16, 6);
    painter.setPen(Qt::NoPen);
    painter.setBrush(colours().grid);
    painter.drawRect(bar);
    painter.setBrush(theme::colour(condition));
    painter.drawRect(QRectF(bar.topLeft(), QSizeF(bar.width() * reliability, bar.height())));
    painter.setBrush(Qt::NoBrush);
    painter.setPen(isLost ? theme::colour(condition) : colours().text);
    painter.drawText(box.topLeft() + QPointF(8, 4 + metrics.ascent()), lines[0]);
    painter.setPen(colours().text);
    painter.drawText(box.topLeft() + QPointF(8, 4 + height + metrics.ascent()), lines[1]);
}

} // namespace hermes::desktop
