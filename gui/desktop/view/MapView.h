#pragma once

#include "gui/desktop/view/MapPainter.h"

#include <QWidget>

namespace hermes::desktop {

class PlainLabel;

/// The map: pan with the mouse, zoom with the wheel or + and -, F follows the robot, 0 shows everything.
class MapView : public QWidget {
    Q_OBJECT
public:
    /// What a click means.
    enum class Tool {
        Pan,
        Measure, ///< from press to release: a distance
        Place,   ///< press where the robot is, drag to where it looks
    };

    MapView(const MapModel &model, QWidget *parent = nullptr);

    MapLayers &layers() { return layers_; }
    void setTool(Tool tool);
    Tool tool() const { return tool_; }
    bool isFollowing() const { return isFollowing_; }
    void setFollowing(bool isFollowing);
    /// All of the map is shown, also while it grows, until the operator zooms, pans or follows.
    bool isFitting() const { return isFitting_; }
    void setFitting(bool isFitting);
    void fit() { setFitting(true); }
    static constexpr double step = 1.2;
    void zoom(double factor) { zoomAt(rect().center(), factor); }
    /// World to screen: metres to pixels, y up.
    QTransform transform() const;
    /// Draws what the view shows, without the tools.
    void render(QPainter &painter) const { MapPainter(model_, layers_, transform(), size()).paint(painter); }
    QSize sizeHint() const override { return {640, 480}; }

Q_SIGNALS:
    void followingChanged(bool isFollowing);
    void fittingChanged(bool isFitting);
    void toolChanged();
    /// The operator has put the robot here; metres and radians in the map's frame.
    void placed(const vectorlib::Pose2D &pose);
    /// Metres; while measuring.
    void measured(double distance_m);

protected:
    void paintEvent(QPaintEvent *event) override;
    void wheelEvent(QWheelEvent *event) override;
    void mousePressEvent(QMouseEvent *event) override;
    void mouseMoveEvent(QMouseEvent *event) override;
    void mouseReleaseEvent(QMouseEvent *event) override;
    void keyPressEvent(QKeyEvent *event) override;
    void resizeEvent(QResizeEvent *event) override;
    void leaveEvent(QEvent *event) override;

private:
    void zoomAt(QPointF pixel, double factor);
    void refresh();
    bool showsAll() const;
    void showAll();
    void showFirst();
    void keepScale();
    void fitTo(double across_m, double along_m);
    void tellCursor();
    QPointF toWorld(QPointF pixel) const { return transform().inverted().map(pixel); }
    void paintTool(QPainter &painter) const;

    const MapModel &model_;
    MapLayers layers_;
    Tool tool_ = Tool::Pan;
    bool isFollowing_ = true, isFitting_ = false;
    const DaemonLink *fitted_ = nullptr; // whose map was fitted to the view
    bool isUntouched_ = false;           // it is as it was fitted
    QSize fittedSize_;                   // pixels of the view, when it was fitted
    std::optional<QPoint> cursor_;       // pixels
    PlainLabel *cursorLabel_;
    double pixelsPerMetre_ = 40;
    QPointF centre_;                 // metres
    std::optional<QPointF> pressed_; // metres; pixels while panning
    QPointF dragged_;                // metres
};

} // namespace hermes::desktop
