#pragma once

#include "gui/desktop/model/TopicSampler.h"
#include "gui/desktop/view/CurveLine.h"
#include "gui/desktop/view/TimeWindow.h"
#include "gui/desktop/view/ValueAxis.h"

#include <QPainter>
#include <QPalette>
#include <vector>

namespace hermes::desktop {

/// A curve as it is drawn.
struct PlotLine {
    FieldId field;
    QString name, unit;
    QPen pen;
    bool isRight = false; ///< of the axis on the right
    double now = 0;       ///< the stamp at 0 s of the time window
    const Samples *samples = nullptr;
    bool isOld = false; ///< its newest value is not live any more
    QString silence;    ///< "no data for 3 s"; empty: it is not that old
};

/// Everything that one chart shows.
struct PlotScene {
    std::vector<PlotLine> lines;
    ValueAxis left, right;
    bool hasTimeAxis = true; ///< below; else another chart shows it
    bool hasRightAxis = false;
    bool isChosen = false;
    double legendWidth = 200; ///< the same for all charts that are below each other
    QString cursorTime;       ///< what the time axis says at the cursor
};

/// Draws a chart: value axes, curves, the cursor, and on the right the names with their values there. On a
/// widget and in a file alike.
class PlotPainter {
public:
    PlotPainter(const PlotScene &scene, const TimeWindow &time, const QRectF &place, const QFont &font,
                const QPalette &palette);

    void paint(QPainter &painter) const;
    /// That all names and values have room in, if the chart is wide enough.
    static double legendWidth(const std::vector<PlotLine> &lines, const QFont &font);

    const QRectF &chart() const { return chart_; }
    const QRectF &legend() const { return legend_; }
    /// The value beside the name of a curve: that at the cursor, or the newest shown.
    QString valueText(const PlotLine &line) const;
    /// How many names have room.
    int shownNames() const;

private:
    void paintGrid(QPainter &painter) const;
    void paintValues(QPainter &painter, const ValueAxis &axis, bool isRight) const;
    void paintTimes(QPainter &painter) const;
    void paintCurves(QPainter &painter) const;
    void paintCursor(QPainter &painter) const;
    void paintLegend(QPainter &painter) const;
    QString unitsOf(bool isRight) const;
    int valueTicks() const;
    ChartFrame frameOf(const PlotLine &line) const;
    double xAt(double time_s) const {
        return chart_.left() + (time_s - time_.left_s()) / time_.span_s() * chart_.width();
    }
    bool isCursorSeen() const;
    QRectF cursorBox() const;
    std::optional<QPointF> sampleShown(const PlotLine &line) const;

    const PlotScene &scene_;
    const TimeWindow &time_;
    const QRectF place_;
    const QFont font_;
    const QPalette palette_;
    const double lineHeight_;
    QRectF chart_, legend_;
};

/// Sensible digits: "0.402", "24.31", "1513".
QString valueText(double value);
/// The colour and the style of the curve of this number.
QPen curvePen(int number);

} // namespace hermes::desktop
