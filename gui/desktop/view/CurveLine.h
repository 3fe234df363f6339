#pragma once

#include "gui/desktop/model/TopicSampler.h"

#include <QPolygonF>
#include <optional>

namespace hermes::desktop {

/// How stamps and values become places in a chart.
struct ChartFrame {
    QRectF chart;
    double from = 0, to = 1; ///< stamps at its left and right edge
    double least = 0, most = 1;

    double x(double stamp) const { return chart.left() + (stamp - from) / (to - from) * chart.width(); }
    double y(double value) const;
};

/// The lines through samples: no more than four points for each column of pixels, which are its first, least,
/// greatest and last. None goes across where samples are missing.
QVector<QPolygonF> curveLines(const Samples &samples, const ChartFrame &frame);

/// The sample whose stamp is nearest, when there is one near enough to be seen at that place in a window of
/// so many seconds, or on a line over it.
std::optional<QPointF> nearest(const Samples &samples, double stamp, double span_s);

/// The least and the greatest value between two stamps; nothing: no samples.
std::optional<std::pair<double, double>> extremes(const Samples &samples, double from, double to);

} // namespace hermes::desktop
