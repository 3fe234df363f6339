#include "gui/desktop/view/CloudCamera.h"

#include <QVector3D>
#include <QtMath>

namespace hermes::desktop {
namespace {

constexpr float opening_deg = 45; // from the bottom of the view to its top
constexpr double nearestEye_m = 0.5, farthestEye_m = 2000;

} // namespace

void CloudCamera::reset(double reach_m) {
    *this = {};
    distance_m_ = qBound(4.0, 1.9 * reach_m, farthestEye_m);
}

void CloudCamera::orbit(double turn_deg, double lift_deg) {
    turn_deg_ = std::remainder(turn_deg_ + turn_deg, 360);
    lift_deg_ = qBound(0.0, lift_deg_ + lift_deg, 90.0);
}

void CloudCamera::pan(QPointF way) {
    const double height_m = 2 * distance_m_ * std::tan(qDegreesToRadians(double(opening_deg)) / 2);
    const QVector3D onScreen(float(way.x() * height_m), float(way.y() * height_m), 0);
    point_ -= rotation().transposed().mapVector(onScreen);
    for (int axis = 0; axis < 3; ++axis)
        point_[axis] = qBound(float(-farthestEye_m), point_[axis], float(farthestEye_m));
}

void CloudCamera::zoom(double factor) {
    distance_m_ = qBound(nearestEye_m, distance_m_ / factor, farthestEye_m);
}

/// From the sensor's axes to right, up and towards the eye; ahead is up in a view from above.
QMatrix4x4 CloudCamera::rotation() const {
    QMatrix4x4 rotation;
    rotation.rotate(float(lift_deg_ - 90), 1, 0, 0);
    rotation.rotate(float(90 - turn_deg_), 0, 0, 1);
    return rotation;
}

QMatrix4x4 CloudCamera::matrix(const QSize &size) const {
    QMatrix4x4 matrix;
    const float distance = float(distance_m_);
    matrix.perspective(opening_deg, float(size.width()) / float(qMax(1, size.height())), distance / 50,
                       20 * distance + 1000);
    matrix.translate(0, 0, -distance);
    matrix *= rotation();
    matrix.translate(-point_);
    return matrix;
}

} // namespace hermes::desktop
