#include "daemons/motorcontrol/Odometry.h"

#include <cmath>

namespace hermes::motorcontrol {
namespace {

double square(double value) {
    return value * value;
}

} // namespace

void Odometry::move(const Twist2D &displacement) {
    const Pose2D next = pose_ * displacement.motion(1);
    const double dx = next.x - pose_.x, dy = next.y - pose_.y;

    // P' = F P F' + Q with F = [1 0 -dy; 0 1 dx; 0 0 1]: a wrong heading turns the step.
    Covariance &p = covariance_;
    const double xt = p[2] - dy * p[8], yt = p[5] + dx * p[8];
    const double xx = p[0] - dy * (p[2] + xt), yy = p[4] + dx * (p[5] + yt);
    const double xy = p[1] + dx * p[2] - dy * yt;
    const double length = std::hypot(displacement.vx, displacement.vy);
    const double position = square(noise_.positionPerMetre) * length;
    const double heading = square(noise_.headingPerMetre) * length +
                           square(noise_.headingPerRadian) * std::abs(displacement.omega);
    p = {xx + position, xy, xt, xy, yy + position, yt, xt, yt, p[8] + heading};

    pose_ = next;
}

void Odometry::doubt(double metres, double radians) {
    covariance_[0] += square(metres);
    covariance_[4] += square(metres);
    covariance_[8] += square(radians);
}

void Odometry::reset(const Pose2D &pose) {
    pose_ = {pose.x, pose.y, vectorlib::wrapAngle(pose.theta)};
    covariance_ = {};
}

} // namespace hermes::motorcontrol
