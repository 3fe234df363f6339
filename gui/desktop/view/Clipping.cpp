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

QPolygonF recent(const QPolygonF &path, const QRectF &rect, double longest) {
    double length = 0;
    int first = path.size() - 1;
    for (; first > 0 && length < longest; --first)
        if (const auto part = clipped(QLineF(path[first - 1], path[first]), rect))
            length += part->length();
    return first > 0 ? QPolygonF(path.mid(first)) : path;
}

std::vector<QPolygonF> unbroken(const QPolygonF &path, double longestStep) {
    std::vector<QPolygonF> pieces;
    int begin = 0;
    for (int i = 1; i < path.size(); ++i)
        if (QLineF(path[i - 1], path[i]).length() > longestStep) {
            pieces.push_back(path.mid(begin, i - begin));
            begin = i;
        }
    pieces.push_back(begin == 0 ? path : QPolygonF(path.mid(begin)));
    return pieces;
}

} // namespace hermes::desktop
