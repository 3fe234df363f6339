// How a map painter draws the graph of the drive: key scans, loops and trust.
#include "gui/desktop/view/MapColours.h"
#include "gui/desktop/view/MapPainter.h"

#include <QPainter>

namespace hermes::desktop {
namespace {

/// Pixels between key scans that are drawn, and how many dots at most.
constexpr double leastStep = 8;
constexpr int maxDots = 10000;

double trustWidth(std::size_t trustClass) {
    return 9 - double(trustClass);
}

/// Of so many classes; trust in 0 to 1.
int classOf(double trust, std::size_t classes) {
    return qMin(int(trust * double(classes)), int(classes) - 1);
}

} // namespace

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
    QVector<QRectF> dots; // drawn faster than points of a wide pen
    int leftOut = 0;
    for (const Step &step : drive()) {
        lines.append(step.line);
        const bool isSeen = seen.contains(step.line.p2());
        leftOut += isSeen && dots.size() >= maxDots;
        if (isSeen && dots.size() < maxDots)
            dots.append(QRectF(step.line.p2() - QPointF(2, 2), QSizeF(5, 5)));
    }
    leftOut += paintLines(painter, lines, QPen(mapColours().text, 1));
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setPen(Qt::NoPen);
    painter.setBrush(mapColours().text);
    painter.drawRects(dots);
    painter.setBrush(Qt::NoBrush);
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
    QColor faint = mapColours().truth;
    faint.setAlpha(130);
    return paintLines(painter, refused, QPen(faint, 1, Qt::DashLine)) +
           paintLines(painter, closed, QPen(mapColours().loop, 1.5));
}

// Least trust is widest: what is to be looked at stands out, to those who see no colour, too.
int MapPainter::paintTrust(QPainter &painter) const {
    const auto palette = mapColours().trust;
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
    const auto palette = mapColours().trust;
    const QFontMetrics metrics(painter.font());
    const double part = 26, width = double(palette.size()) * part + 16, height = 2 * metrics.height() + 14;
    const QRectF box(size_.width() - 12 - width, 12, width, height);
    paintBox(painter, box);
    painter.setPen(mapColours().text);
    painter.drawText(box.adjusted(8, 2, -8, 0), Qt::AlignHCenter | Qt::AlignTop, QObject::tr("trust"));
    painter.drawText(box.adjusted(8, 0, -8, -2), Qt::AlignLeft | Qt::AlignBottom, "0");
    painter.drawText(box.adjusted(8, 0, -8, -2), Qt::AlignRight | Qt::AlignBottom, "1");
    for (std::size_t i = 0; i < palette.size(); ++i) {
        painter.setPen(QPen(palette[i], trustWidth(i), Qt::SolidLine, Qt::FlatCap));
        const QPointF from(box.left() + 8 + double(i) * part, box.center().y());
        painter.drawLine(from, from + QPointF(part, 0));
    }
}

} // namespace hermes::desktop
