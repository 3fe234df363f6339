#include "gui/desktop/view/Clipping.h"

#include <algorithm>

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

QVector<QPolygonF> recent(const QPolygonF &path, const QVector<int> &breaks, const QTransform &transform,
                          const QRectF &rect, double longest) {
    constexpr double leastStep = 2; // pixels
    QVector<QPolygonF> pieces;
    QPolygonF piece; // the newest point first
    const auto end = [&] {
        std::reverse(piece.begin(), piece.end());
        if (piece.size() > 1)
            pieces.append(piece);
        piece.clear();
    };
    double length = 0;
    auto begin = breaks.crbegin();
    for (int i = path.size() - 1; i >= 0 && length < longest; --i) {
        while (begin != breaks.crend() && *begin > i)
            ++begin;
        const bool isFirst = i == 0 || (begin != breaks.crend() && *begin == i);
        const QPointF at = transform.map(path[i]);
        if (!isFirst && !piece.isEmpty() && (at - piece.back()).manhattanLength() < leastStep)
            continue;
        if (!piece.isEmpty())
            if (const auto part = clipped(QLineF(at, piece.back()), rect))
                length += part->length();
        piece.append(at);
        if (isFirst)
            end();
    }
    end();
    return pieces;
}

} // namespace hermes::desktop
