#pragma once

#include <QMatrix4x4>
#include <QPointF>
#include <QSize>

namespace hermes::desktop {

/// From where a cloud is looked at: a point around which the eye turns, the side it looks from, and its
/// distance. Metres and degrees in the frame of the sensor, z up.
class CloudCamera {
public:
    /// From behind and above, so that all within this distance of the sensor is seen.
    void reset(double reach_m);
    /// Turns the eye around the point, and lifts it, down to the level and up to straight above.
    void orbit(double turn_deg, double lift_deg);
    /// Moves the point by parts of the view's height: right and up.
    void pan(QPointF way);
    /// Nearer with factors above 1.
    void zoom(double factor);

    /// From metres to clip coordinates.
    QMatrix4x4 matrix(const QSize &size) const;
    double distance_m() const { return distance_m_; }
    double turn_deg() const { return turn_deg_; }
    double lift_deg() const { return lift_deg_; }
    const QVector3D &point() const { return point_; }

private:
    QMatrix4x4 rotation() const;

    QVector3D point_;
    double turn_deg_ = 0, lift_deg_ = 40, distance_m_ = 20;
};

} // namespace hermes::desktop
