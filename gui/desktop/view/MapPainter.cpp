#include "gui/desktop/view/MapPainter.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/view/Clipping.h"
#include "gui/desktop/view/MapColours.h"

#include <QPainter>
#include <QtMath>

namespace hermes::desktop {
namespace {

constexpr double robotRadius_m = 0.3; // as large as it is drawn
/// One pixel lines are fast without smoothing; beyond so many lines nobody sees the difference.
constexpr int smoothUpTo = 2000;
/// Pixels of lines that are drawn smoothly, and at all: a picture is not to take longer than 50 ms.
constexpr double longestSmooth = 2e5, longestDrawn = 1e6, longestDashed = 4e4;

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

void paintWay(QPainter &painter, const QPolygonF &way, const QVector<int> &breaks,
              const QTransform &transform, const QSize &size, QPen pen) {
    const double longest = pen.style() == Qt::SolidLine ? longestSmooth : longestDashed;
    const auto pieces = recent(way, breaks, transform, QRectF(QPointF(), size), longest);
    int points = 0;
    for (const QPolygonF &piece : pieces)
        points += piece.size();
    painter.setRenderHint(QPainter::Antialiasing, points <= smoothUpTo);
    if (points > smoothUpTo)
        pen.setWidth(1);
    painter.setPen(pen);
    for (const QPolygonF &piece : pieces)
        painter.drawPolyline(piece);
}

void MapPainter::paint(QPainter &painter) const {
    const MapColours c = mapColours();
    painter.fillRect(QRect({}, size_), c.background);
    if (layers_.grid)
        paintGrid(painter);
    int leftOut = 0;
    const auto paintPath = [&](MovingMap::Path path, const QPen &pen) {
        paintWay(painter, model_.way(path), model_.breaks(path), transform_, size_, pen);
    };
    if (layers_.map)
        leftOut += paintLines(painter, mapped(model_.edges(), transform_), QPen(c.map, 2));
    if (layers_.scan)
        paintScan(painter);
    if (layers_.correspondences && !model_.isGliding())
        leftOut += paintCorrespondences(painter);
    if (layers_.segments)
        leftOut += paintLines(painter, mapped(model_.segments(), sensorTransform()),
                              QPen(agedColour(c.accent, model_.poseAge()), 2));
    if (layers_.truth)
        paintPath(MovingMap::Truth, QPen(c.truth, 1.5, Qt::DotLine));
    if (layers_.odometry)
        paintPath(MovingMap::Odometry, QPen(c.odometry, 1.5, Qt::DashLine));
    if (layers_.path)
        paintPath(MovingMap::Matched, QPen(c.path, 1.5));
    if (layers_.trust)
        leftOut += paintTrust(painter);
    if (layers_.graph)
        leftOut += paintGraph(painter);
    if (layers_.loops)
        leftOut += paintLoops(painter);
    if (layers_.uncertainty && model_.pose())
        paintUncertainty(painter);
    if (layers_.robot && model_.pose())
        paintRobot(painter);
    if (layers_.grid)
        paintScaleBar(painter, gridStep_m(scale()));
    if (layers_.trust)
        paintTrustLegend(painter);
    if (layers_.numbers && model_.pose())
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

} // namespace hermes::desktop
