#include "daemons/motorcontrol/Odometry.h"

#include <cmath>

namespace hermes {
namespace {

constexpr double pi = 3.14159265358979323846;

double wrapped(double angle) {
    const double a = std::remainder(angle, 2 * pi);
    return a <= -pi ? pi : a;
}

double square(double value) {
    return value * value;
}

} // namespace

void Odometry::move(const Twist &d) {
    const double turn = d.omega;
    const bool straight = std::abs(turn) < 1e-4; // where the fractions lose digits; the series has 1e-17
    const double a = straight ? 1 - turn * turn / 6 : std::sin(turn) / turn;
    const double b = straight ? turn / 2 - turn * turn * turn / 24 : (1 - std::cos(turn)) / turn;
    const double ahead = a * d.vx - b * d.vy, left = b * d.vx + a * d.vy;
    const double c = std::cos(pose_.theta), s = std::sin(pose_.theta);
    const double dx = c * ahead - s * left, dy = s * ahead + c * left;

    // P' = F P F' + Q with F = [1 0 -dy; 0 1 dx; 0 0 1]: a wrong heading turns the step.
    Covariance &p = covariance_;
    const double xt = p[2] - dy * p[8], yt = p[5] + dx * p[8];
    const double xx = p[0] - dy * (p[2] + xt), yy = p[4] + dx * (p[5] + yt);
    const double xy = p[1] + dx * p[2] - dy * yt;
    const double length = std::hypot(d.vx, d.vy);
    const double position = square(noise_.positionPerMetre) * length;
    const double heading =
        square(noise_.headingPerMetre) * length + square(noise_.headingPerRadian) * std::abs(turn);
    p = {xx + position, xy, xt, xy, yy + position, yt, xt, yt, p[8] + heading};

    pose_ = {pose_.x + dx, pose_.y + dy, wrapped(pose_.theta + turn)};
}

void Odometry::doubt(double metres, double radians) {
    covariance_[0] += square(metres);
    covariance_[4] += square(metres);
    covariance_[8] += square(radians);
}

void Odometry::reset(const Pose &pose) {
    pose_ = {pose.x, pose.y, wrapped(pose.theta)};
    covariance_ = {};
}

} // namespace hermes
