#include "gui/desktop/view/MapPainter.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/view/Clipping.h"
#include "gui/desktop/view/MapColours.h"

#include <QPainter>
#include <QPainterPath>
#include <QtMath>

namespace hermes::desktop {
namespace {

constexpr double robotRadius_m = 0.3; // as large as it is drawn
/// One pixel lines are fast without smoothing; beyond so many lines nobody sees the difference.
constexpr int smoothUpTo = 2000;
/// Pixels of lines that are drawn smoothly, and at all: a picture is not to take longer than 50 ms.
constexpr double longestSmooth = 2e5, longestDrawn = 1e6, longestDashed = 4e4;
constexpr double longestStep_m = 1; // of a path: farther on a replay was sought, or the robot was placed

QVector<QLineF> mapped(const QVector<QLineF> &lines, const QTransform &transform) {
    QVector<QLineF> result;
    result.reserve(lines.size());
    for (const QLineF &line : lines)
        result.append(transform.map(line));
    return result;
}

/// Grey where it is old: that is not where things are now.
QColor agedColour(const QColor &colour, const Freshness &age) {
    return age.state() == Freshness::State::Fresh ? colour : theme::colour(Condition::Unreachable);
}

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
    const MapColours c = mapColours();
    painter.fillRect(QRect({}, size_), c.background);
    if (layers_.grid)
        paintGrid(painter);
    int leftOut = 0;
    if (layers_.map)
        leftOut += paintLines(painter, mapped(model_.edges(), transform_), QPen(c.map, 2));
    if (layers_.scan)
        paintScan(painter);
    if (layers_.correspondences && !model_.isGliding())
        leftOut += paintCorrespondences(painter);
    if (layers_.segments)
        leftOut += paintLines(painter, mapped(model_.segments(), sensorTransform()),
                              QPen(agedColour(c.accent, model_.poseAge()), 2));
    if (layers_.paths) {
        paintPath(painter, model_.truthPath(), c.truth, Qt::DotLine);
        paintPath(painter, model_.odometryPath(), c.odometry, Qt::DashLine);
        paintPath(painter, model_.matchedPath(), c.path, Qt::SolidLine);
    }
    if (layers_.trust)
        leftOut += paintTrust(painter);
    if (layers_.graph)
        leftOut += paintGraph(painter);
    if (layers_.loops)
        leftOut += paintLoops(painter);
    if (layers_.robot && model_.pose()) {
        paintUncertainty(painter);
        paintRobot(painter);
    }
    if (layers_.grid)
        paintScaleBar(painter, gridStep_m(scale()));
    if (layers_.trust)
        paintTrustLegend(painter);
    if (model_.pose())
        paintMatch(painter);
    paintCorrection(painter);
    paintNotice(painter, leftOut);
}

void MapPainter::paintGrid(QPainter &painter) const {
    const MapColours c = mapColours();
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

int MapPainter::paintLines(QPainter &painter, const QVector<QLineF> &lines, QPen pen) const {
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
    const bool isDashed = pen.style() != Qt::SolidLine;
    const bool isSmooth = shown.size() <= smoothUpTo && length <= (isDashed ? longestDashed : longestSmooth);
    painter.setRenderHint(QPainter::Antialiasing, isSmooth);
    if (!isSmooth)
        pen = QPen(pen.color(), 1);
    painter.setPen(pen);
    painter.drawLines(shown);
    return leftOut;
}

QTransform MapPainter::sensorTransform() const {
    if (!model_.isGliding() || !model_.pose())
        return transform_;
    const Pose2D shift = *model_.shownPose() * model_.pose()->inverse();
    const double c = std::cos(shift.theta), s = std::sin(shift.theta);
    return QTransform(c, s, -s, c, shift.x, shift.y) * transform_;
}

void MapPainter::paintScan(QPainter &painter) const {
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(QPen(agedColour(mapColours().scan, model_.scanAge()), 2));
    painter.drawPoints(sensorTransform().map(model_.scan()));
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
    return paintLines(painter, arrows, QPen(mapColours().correspondence, 1));
}

void MapPainter::paintPath(QPainter &painter, const QPolygonF &path, const QColor &colour,
                           Qt::PenStyle style) const {
    painter.setRenderHint(QPainter::Antialiasing, path.size() <= smoothUpTo);
    painter.setPen(QPen(colour, 1.5, style));
    for (const QPolygonF &piece : unbroken(path, longestStep_m))
        painter.drawPolyline(recent(transform_.map(piece), QRectF(QPointF(), size_), longestSmooth));
}

// The ellipse and the pie hold the pose with 95 %, and are drawn ten times their size: on a good day
// nobody could see them otherwise. The legend says so.
void MapPainter::paintUncertainty(QPainter &painter) const {
    if (!model_.covariance())
        return;
    constexpr double enlarged = 10, chi95 = 2.4477, normal95 = 1.96;
    const auto &c = *model_.covariance();
    const Pose2D pose = *model_.shownPose();
    const double mean = (c[0] + c[4]) / 2, root = std::hypot((c[0] - c[4]) / 2, c[1]);
    const auto axis = [&](double variance) { // no longer than anything that can be seen
        return qMin(chi95 * enlarged * std::sqrt(qMax(0.0, variance)) * scale(), 1e5);
    };
    QColor fill = mapColours().path;
    fill.setAlpha(50);
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing, true);
    painter.setPen(QPen(mapColours().path, 1));
    painter.setBrush(fill);
    painter.translate(transform_.map(QPointF(pose.x, pose.y)));
    const double spread = qMin(180.0, qRadiansToDegrees(normal95 * enlarged * std::sqrt(qMax(0.0, c[8]))));
    const double radius = 2.5 * robotRadius_m * scale(), heading = qRadiansToDegrees(pose.theta);
    painter.drawPie(QRectF(-radius, -radius, 2 * radius, 2 * radius), qRound(16 * (heading - spread)),
                    qRound(16 * 2 * spread));
    painter.rotate(-qRadiansToDegrees(std::atan2(2 * c[1], c[0] - c[4]) / 2));
    painter.drawEllipse(QPointF(), axis(mean + root), axis(mean - root));
    painter.restore();
}

void MapPainter::paintRobot(QPainter &painter) const {
    const Pose2D pose = *model_.shownPose();
    const double r = robotRadius_m;
    const auto at = [&](double x, double y) { return transform_.map(pose * QPointF(x, y)); };
    painter.setRenderHint(QPainter::Antialiasing, true);
    const QColor colour = agedColour(mapColours().robot, model_.poseAge());
    QColor fill = colour;
    painter.setPen(QPen(fill, 2));
    fill.setAlpha(60);
    painter.setBrush(fill);
    painter.drawEllipse(at(0, 0), r * scale(), r * scale());
    painter.setBrush(colour);
    painter.drawPolygon(QVector<QPointF>{at(r, 0), at(0.3 * r, 0.35 * r), at(0.3 * r, -0.35 * r)});
    painter.setBrush(Qt::NoBrush);
}

void MapPainter::paintBox(QPainter &painter, const QRectF &box) const {
    QColor back = mapColours().background;
    back.setAlpha(220);
    painter.setRenderHint(QPainter::Antialiasing, true);
    painter.setPen(QPen(mapColours().grid, 1));
    painter.setBrush(back);
    painter.drawRoundedRect(box, 4, 4);
    painter.setBrush(Qt::NoBrush);
}

void MapPainter::paintScaleBar(QPainter &painter, double step_m) const {
    const double length = step_m * scale();
    const QPointF right(size_.width() - 12, size_.height() - 12), left = right - QPointF(length, 0);
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(QPen(mapColours().text, 2));
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
    const Freshness &age = model_.poseAge();
    const Condition condition = !age.isFresh()      ? Condition::Unreachable
                                : isLost            ? Condition::Fault
                                : reliability < 0.1 ? Condition::Warning
                                                    : Condition::Ready;
    QStringList lines{QObject::tr("%1, reliability %2").arg(model_.outcome()).arg(reliability, 0, 'f', 2),
                      QObject::tr("ambiguity %1 m²").arg(model_.ambiguity(), 0, 'g', 2)};
    if (model_.trust())
        lines.append(QObject::tr("trust of the pose %1").arg(*model_.trust(), 0, 'f', 2));
    const int struck = age.state() == Freshness::State::Silent ? lines.size() : 0; // what held once
    if (struck > 0)
        lines.append(age.text());
    const QFontMetrics metrics(painter.font());
    const int height = metrics.height();
    int width = 0;
    for (const QString &line : lines)
        width = qMax(width, metrics.horizontalAdvance(line));
    const QRectF box(12, 12, width + 24, lines.size() * height + 24);
    paintBox(painter, box);
    const QRectF bar = QRectF(box.left() + 8, box.bottom() - 14, box.width() - 16, 6);
    painter.setPen(Qt::NoPen);
    painter.setBrush(mapColours().grid);
    painter.drawRect(bar);
    painter.setBrush(theme::colour(condition));
    painter.drawRect(QRectF(bar.topLeft(), QSizeF(bar.width() * reliability, bar.height())));
    painter.setBrush(Qt::NoBrush);
    for (int i = 0; i < lines.size(); ++i) {
        painter.setPen(!age.isFresh() || (isLost && i == 0) ? theme::colour(condition) : mapColours().text);
        QFont font = painter.font();
        font.setStrikeOut(i < struck);
        painter.setFont(font);
        painter.drawText(box.topLeft() + QPointF(8, 4 + i * height + metrics.ascent()), lines[i]);
    }
}

// What an operator must know who saw the map move, or looked elsewhere.
void MapPainter::paintCorrection(QPainter &painter) const {
    if (!model_.correction_m())
        return;
    const QString text = QObject::tr("map corrected: %1 m").arg(*model_.correction_m(), 0, 'f', 2);
    const QFontMetrics metrics(painter.font());
    constexpr int narrow = 640; // pixels: what stands in the corners leaves no room between
    QRectF box(0, size_.width() < narrow ? 5 * metrics.height() : 12, metrics.horizontalAdvance(text) + 24,
               metrics.height() + 12);
    box.moveLeft((size_.width() - box.width()) / 2);
    paintBox(painter, box);
    painter.setPen(mapColours().text);
    painter.drawText(box, Qt::AlignCenter, text);
}

} // namespace hermes::desktop
