#pragma once

#include "gui/desktop/view/PlotPainter.h"

#include <QWidget>

namespace hermes::desktop {

/// One chart of the plots. The wheel changes the time window, with Shift it goes back in time, as dragging
/// does, with Ctrl it zooms the values; a double click brings all back to live. So do Page up and Page down,
/// with Ctrl, and End.
class PlotPane : public QWidget {
    Q_OBJECT
public:
    PlotPane(TimeWindow &time, QWidget *parent = nullptr);

    PlotScene &scene() { return scene_; }
    const PlotScene &scene() const { return scene_; }
    /// Fits the axes that nobody zoomed to the curves, and draws anew.
    void refresh();
    PlotPainter painter(const QRectF &place) const { return {scene_, time_, place, smallFont(), palette()}; }
    double legendWidth() const { return PlotPainter::legendWidth(scene_.lines, smallFont()); }
    /// The value beside the name of a curve, as it is shown.
    QString valueText(int line) const {
        return painter(rect()).valueText(scene_.lines.at(std::size_t(line)));
    }

    QSize sizeHint() const override { return {400, 160}; }

Q_SIGNALS:
    void chosen();
    /// Back to live, with automatic axes, everywhere.
    void liveWanted();
    void menuWanted(const QPoint &global);

protected:
    bool event(QEvent *event) override;
    void paintEvent(QPaintEvent *event) override;
    void wheelEvent(QWheelEvent *event) override;
    void mousePressEvent(QMouseEvent *event) override;
    void mouseMoveEvent(QMouseEvent *event) override;
    void mouseReleaseEvent(QMouseEvent *) override { dragged_.reset(); }
    void mouseDoubleClickEvent(QMouseEvent *) override { Q_EMIT liveWanted(); }
    void leaveEvent(QEvent *) override { time_.setCursor(std::nullopt); }
    void keyPressEvent(QKeyEvent *event) override;
    void focusInEvent(QFocusEvent *event) override;
    void contextMenuEvent(QContextMenuEvent *event) override;

private:
    void fit(ValueAxis &axis, bool isRight);
    /// The cursor of all charts is where the mouse is.
    void pointAt(const QPointF &place);
    void zoomValues(double factor, double share);
    QString toolTipAt(const QPoint &place) const;
    QFont smallFont() const;

    TimeWindow &time_;
    PlotScene scene_;
    std::optional<QPointF> dragged_; ///< where the mouse was
    bool isDragging_ = false;        ///< it has moved further than a click does
};

} // namespace hermes::desktop
