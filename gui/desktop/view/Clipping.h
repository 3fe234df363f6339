#pragma once

#include <QLineF>
#include <QPolygonF>
#include <QRectF>
#include <QTransform>
#include <optional>

namespace hermes::desktop {

/// The part of a line within a rectangle, by Liang and Barsky; nothing: it does not meet it.
std::optional<QLineF> clipped(const QLineF &line, const QRectF &rect);

/// The end of a path on the screen, back to where the part of it within the rectangle is longer than so much,
/// in pieces: breaks are the numbers of the points that begin one, ascending. Points within two pixels of the
/// next are left out, and pieces of one point.
QVector<QPolygonF> recent(const QPolygonF &path, const QVector<int> &breaks, const QTransform &transform,
                          const QRectF &rect, double longest);

} // namespace hermes::desktop
