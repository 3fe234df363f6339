#include "gui/desktop/view/MapPainter.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/view/Clipping.h"

#include <QPainter>
#include <QPainterPath>
#include <QtMath>

namespace hermes::desktop {
namespace {

struct Colours {
    QColor background, grid, axis, map, accent, scan, correspondence, path, odometry, truth, robot, text,
        loop;
    std::array<QColor, 5> trust; // from none to full: orange to blue, which all eyes tell apart
};

Colours colours() {
    if (theme::isDark())
        return {QColor(0x17, 0x1a, 0x1c),
                QColor(0x2a, 0x2f, 0x33),
                QColor(0x45, 0x4c, 0x52),
                QColor(0xd5, 0xda, 0xde),
                QColor(0x4d, 0xc4, 0xff),
                QColor(0xc9, 0x8a, 0x2b),
                QColor(0x6d, 0x8b, 0x74),
                QColor(0x5a, 0xa9, 0xff),
                QColor(0xb8, 0x8c, 0xe0),
                QColor(0x8f, 0x98, 0x9f),
                QColor(0xff, 0x8a, 0x3d),
                QColor(0xc3, 0xc9, 0xce),
                QColor(0xf0, 0xe4, 0x42),
                {QColor(0xff, 0x7a, 0x1a), QColor(0xf2, 0xb1, 0x6e), QColor(0xd8, 0xd4, 0xc8),
                 QColor(0x85, 0xb4, 0xe0), QColor(0x35, 0x8c, 0xe8)}};
    return {QColor(0xfc, 0xfc, 0xfb),
            QColor(0xe9, 0xea, 0xe8),
            QColor(0xc9, 0xcc, 0xc9),
            QColor(0x24, 0x29, 0x2e),
            QColor(0x00, 0x7d, 0xc5),
            QColor(0xb8, 0x5c, 0x00),
            QColor(0x86, 0xa8, 0x8c),
            QColor(0x0b, 0x63, 0xc4),
            QColor(0x8a, 0x4f, 0xbf),
            QColor(0x6a, 0x71, 0x78),
            QColor(0xd9, 0x53, 0x00),
            QColor(0x3b, 0x41, 0x47),
            QColor(0x7d, 0x6f, 0x00),
            {QColor(0xc4, 0x4e, 0x00), QColor(0xe0, 0x8e, 0x4c), QColor(0xa8, 0xa4, 0x98),
             QColor(0x5b, 0x93, 0xc9), QColor(0x0a, 0x4f, 0xa0)}};
}

constexpr double robotRadius_m = 0.3; // as large as it is drawn
/// One pixel lines are fast without smoothing; beyond so many lines nobody sees the difference.
constexpr int smoothUpTo = 2000;
/// Pixels of lines that are drawn smoothly, and at all: a picture is not to take longer than 50 ms.
constexpr double longestSmooth = 2e5, longestDrawn = 1e6, longestDashed = 4e4;
/// Pixels between key scans that are drawn, and how many dots at most.
constexpr double leastStep = 4;
constexpr int mostDots = 10000;

QVector<QLineF> mapped(const QVector<QLineF> &lines, const QTransform &transform) {
    QVector<QLineF> result;
    result.reserve(lines.size());
    for (const QLineF &line : lines)
        result.append(transform.map(line));
    return result;
}

double trustWidth(std::size_t trustClass) {
    return 7 - double(trustClass);
}

/// For text on the map.
void paintBox(QPainter &painter, const QRectF &box) {
    QColor back = colours().background;
    back.setAlpha(220);
    painter.setRenderHint(QPainter::Antialiasing, true);
    painter.setPen(QPen(colours().grid, 1));
    painter.setBrush(back);
    painter.drawRoundedRect(box, 4, 4);
    painter.setBrush(Qt::NoBrush);
}

/// Of so many classes; trust in 0 to 1.
int classOf(double trust, std::size_t classes) {
    return qMin(int(trust * double(classes)), int(classes) - 1);
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
    const Colours c = colours();
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
        leftOut += paintLines(painter, mapped(model_.segments(), sensorTransform()), QPen(c.accent, 2));
    if (layers_.trust)
        leftOut += paintTrust(painter);
    if (layers_.graph)
        leftOut += paintGraph(painter);
    if (layers_.loops)
        leftOut += paintLoops(painter);
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
    if (layers_.trust)
        paintTrustLegend(painter);
    if (model_.pose())
        paintMatch(painter);
    paintCorrection(painter);
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

std::vector<MapPainter::Step> MapPainter::drive() const {
    const KeyScans &graph = model_.graph();
    std::vector<Step> steps;
    QPointF last;
    double trust = 1;
    for (int i = 0; i < graph.size(); ++i) {
        const QPointF at = transform_.map(QPointF(graph.poses[i].x, graph.poses[i].y));
        trust = qMin(trust, graph.trust[i]);
        const bool isEnd = i == 0 || i == graph.size() - 1;
        if (!isEnd && (at - last).manhattanLength() < leastStep)
            continue;
        steps.push_back({QLineF(i == 0 ? at : last, at), trust});
        last = at;
        trust = graph.trust[i];
    }
    return steps;
}

int MapPainter::paintGraph(QPainter &painter) const {
    const QRectF seen(QPointF(), size_);
    QVector<QLineF> lines;
    QVector<QPointF> dots;
    int leftOut = 0;
    for (const Step &step : drive()) {
        lines.append(step.line);
        const bool isSeen = seen.contains(step.line.p2());
        leftOut += isSeen && dots.size() >= mostDots;
        if (isSeen && dots.size() < mostDots)
            dots.append(step.line.p2());
    }
    leftOut += paintLines(painter, lines, QPen(colours().text, 1));
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(QPen(colours().text, 3));
    painter.drawPoints(dots.data(), dots.size());
    return leftOut;
}

int MapPainter::paintLoops(QPainter &painter) const {
    const KeyScans &graph = model_.graph();
    QVector<QLineF> closed, refused;
    for (const GraphLoop &loop : graph.loops) {
        const Pose2D &from = graph.poses[int(loop.from)], &to = graph.poses[int(loop.to)];
        const QLineF line = transform_.map(QLineF(from.x, from.y, to.x, to.y));
        (loop.weight < KeyScans::leastWeight ? refused : closed).append(line);
    }
    return paintLines(painter, refused, QPen(colours().truth, 1, Qt::DashLine)) +
           paintLines(painter, closed, QPen(colours().loop, 1.5));
}

// Least trust is widest: what is to be looked at stands out, to those who see no colour, too.
int MapPainter::paintTrust(QPainter &painter) const {
    const auto palette = colours().trust;
    std::array<QVector<QLineF>, palette.size()> lines;
    for (const Step &step : drive())
        lines[std::size_t(classOf(step.trust, lines.size()))].append(step.line);
    int leftOut = 0;
    for (std::size_t i = lines.size(); i-- > 0;)
        leftOut +=
            paintLines(painter, lines[i], QPen(palette[i], trustWidth(i), Qt::SolidLine, Qt::RoundCap));
    return leftOut;
}

void MapPainter::paintTrustLegend(QPainter &painter) const {
    const auto palette = colours().trust;
    const QFontMetrics metrics(painter.font());
    const double part = 26, width = double(palette.size()) * part + 16, height = 2 * metrics.height() + 14;
    const QRectF box(size_.width() - 12 - width, 12, width, height);
    paintBox(painter, box);
    painter.setPen(colours().text);
    painter.drawText(box.adjusted(8, 2, -8, 0), Qt::AlignHCenter | Qt::AlignTop, QObject::tr("trust"));
    painter.drawText(box.adjusted(8, 0, -8, -2), Qt::AlignLeft | Qt::AlignBottom, "0");
    painter.drawText(box.adjusted(8, 0, -8, -2), Qt::AlignRight | Qt::AlignBottom, "1");
    for (std::size_t i = 0; i < palette.size(); ++i) {
        painter.setPen(QPen(palette[i], trustWidth(i), Qt::SolidLine, Qt::FlatCap));
        const QPointF from(box.left() + 8 + double(i) * part, box.center().y());
        painter.drawLine(from, from + QPointF(part, 0));
    }
}

void MapPainter::paintScan(QPainter &painter) const {
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(QPen(colours().scan, 2));
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
    return paintLines(painter, arrows, QPen(colours().correspondence, 1));
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
    const Pose2D pose = *model_.shownPose();
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
    QStringList lines{QObject::tr("%1, reliability %2").arg(model_.outcome()).arg(reliability, 0, 'f', 2),
                      QObject::tr("ambiguity %1 m²").arg(model_.ambiguity(), 0, 'g', 2)};
    if (model_.trust())
        lines.append(QObject::tr("trust of the pose %1").arg(*model_.trust(), 0, 'f', 2));
    const QFontMetrics metrics(painter.font());
    const int height = metrics.height();
    int width = 0;
    for (const QString &line : lines)
        width = qMax(width, metrics.horizontalAdvance(line));
    const QRectF box(12, 12, width + 24, lines.size() * height + 24);
    paintBox(painter, box);
    const QRectF bar = QRectF(box.left() + 8, box.bottom() - 14, box.width() - 16, 6);
    painter.setPen(Qt::NoPen);
    painter.setBrush(colours().grid);
    painter.drawRect(bar);
    painter.setBrush(theme::colour(condition));
    painter.drawRect(QRectF(bar.topLeft(), QSizeF(bar.width() * reliability, bar.height())));
    painter.setBrush(Qt::NoBrush);
    for (int i = 0; i < lines.size(); ++i) {
        painter.setPen(isLost && i == 0 ? theme::colour(condition) : colours().text);
        painter.drawText(box.topLeft() + QPointF(8, 4 + i * height + metrics.ascent()), lines[i]);
    }
}

// What an operator must know who saw the map move, or looked elsewhere.
void MapPainter::paintCorrection(QPainter &painter) const {
    if (!model_.correction_m())
        return;
    const QString text = QObject::tr("map corrected: %1 m").arg(*model_.correction_m(), 0, 'f', 2);
    const QFontMetrics metrics(painter.font());
    QRectF box(0, 12, metrics.horizontalAdvance(text) + 24, metrics.height() + 12);
    box.moveLeft((size_.width() - box.width()) / 2);
    paintBox(painter, box);
    painter.setPen(colours().text);
    painter.drawText(box, Qt::AlignCenter, text);
}

} // namespace hermes::desktop
