#include "gui/desktop/view/Clipping.h"

namespace hermes::desktop {

std::optional<QLineF> clipped(const QLineF &line, const QRectF &rect) {
    double from = 0, to = 1;
    const auto cut = [&](double step, double distance) { // step * t <= distance is within
        if (step == 0)
            return distance >= 0;
        (step < 0 ? from : to) = step < 0 ? qMax(from, distance / step) : qMin(to, distance / step);
        return from <= to;
    };
    if (!cut(-line.dx(), line.x1() - rect.left()) || !cut(line.dx(), rect.right() - line.x1()) ||
        !cut(-line.dy(), line.y1() - rect.top()) || !cut(line.dy(), rect.bottom() - line.y1()))
        return std::nullopt;
    return QLineF(line.pointAt(from), line.pointAt(to));
}

QVector<QPolygonF> recent(const QPolygonF &path, const QVector<int> &breaks, const QRectF &rect,
                          double longest) {
    QVector<QPolygonF> pieces;
    double length = 0;
    auto begin = breaks.crbegin();
    for (int first = path.size() - 1, end = path.size(); first >= 0; --first) {
        while (begin != breaks.crend() && *begin > first)
            ++begin;
        const bool isOver = first == 0 || length >= longest;
        if (isOver || (begin != breaks.crend() && *begin == first)) {
            if (end - first > 1)
                pieces.append(QPolygonF(path.mid(first, end - first)));
            end = first;
        } else if (const auto part = clipped(QLineF(path[first - 1], path[first]), rect)) {
            length += part->length();
        }
        if (isOver)
            break;
    }
    return pieces;
}

} // namespace hermes::desktop
