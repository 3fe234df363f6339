#pragma once

#include "gui/desktop/view/MapModel.h"

#include <QPen>
#include <QTransform>
#include <vector>

class QPainter;

namespace hermes::desktop {

/// What of the map is drawn.
struct MapLayers {
    bool grid = true, map = true, scan = true, segments = true, correspondences = true, path = true,
         odometry = true, truth = true, robot = true, uncertainty = true, numbers = true, loops = true,
         graph = false, trust = false;
};

/// With so many decimals, and never "-0.00".
QString fixedNumber(double value, int decimals);
/// "x 1.20 m, y -0.35 m, 12.5°".
QString poseText(const Pose2D &pose);
/// What the pose is within with 95 %: "± 0.012 m, ± 0.009 m, ± 0.3° (95 %)" of x, y and heading.
QString uncertaintyText(const Covariance &covariance);

/// Draws a map model. World to screen is `transform` (metres to pixels, y up).
class MapPainter {
public:
    MapPainter(const MapModel &model, const MapLayers &layers, const QTransform &transform, const QSize &size)
        : model_(model)
        , layers_(layers)
        , transform_(transform)
        , size_(size) {}

    void paint(QPainter &painter) const;

private:
    double scale() const { return transform_.m11(); } // pixels a metre
    void paintGrid(QPainter &painter) const;
    /// What the sensor sees goes with the robot while a correction of the map is shown as a movement.
    QTransform sensorTransform() const;
    /// Lines on the screen; gives how many were left out, for they would take too long.
    int paintLines(QPainter &painter, const QVector<QLineF> &lines, QPen pen) const;
    int paintGraph(QPainter &painter) const;
    int paintLoops(QPainter &painter) const;
    int paintTrust(QPainter &painter) const;
    void paintTrustLegend(QPainter &painter) const;
    void paintScan(QPainter &painter) const;
    int paintCorrespondences(QPainter &painter) const;
    void paintUncertainty(QPainter &painter) const;
    void paintRobot(QPainter &painter) const;
    void paintScaleBar(QPainter &painter, double step_m) const;
    QStringList matchLines() const;
    void paintMatch(QPainter &painter) const;
    void paintCorrection(QPainter &painter) const;
    /// For text on the map.
    void paintBox(QPainter &painter, const QRectF &box) const;
    void paintNotice(QPainter &painter, int leftOut) const;

    /// Part of the drive from key scan to key scan, on the screen.
    struct Step {
        QLineF line;
        double trust; // the least of the key scans it passes
    };
    std::vector<Step> drive() const;

    const MapModel &model_;
    const MapLayers layers_;
    const QTransform transform_;
    const QSize size_;
};

/// Draws a way of the robot (in metres), broken before the points of those numbers: the newest of it, where
/// all would take too long.
void paintWay(QPainter &painter, const QPolygonF &way, const QVector<int> &breaks,
              const QTransform &transform, const QSize &size, QPen pen);

/// The distance between lines of the grid at so many pixels a metre: 1, 2 or 5 times a power of ten, some
/// 80 pixels.
double gridStep_m(double pixelsPerMetre);

} // namespace hermes::desktop
