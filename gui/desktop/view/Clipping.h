#pragma once

#include <QLineF>
#include <QPolygonF>
#include <QRectF>
#include <optional>
#include <vector>

namespace hermes::desktop {

/// The part of a line within a rectangle, by Liang and Barsky; nothing: it does not meet it.
std::optional<QLineF> clipped(const QLineF &line, const QRectF &rect);

/// The end of a path, back to where the part of it within the rectangle is longer than so much.
QPolygonF recent(const QPolygonF &path, const QRectF &rect, double longest);

/// A path in pieces, broken where a step is longer than so much.
std::vector<QPolygonF> unbroken(const QPolygonF &path, double longestStep);

} // namespace hermes::desktop
