#include "daemons/motorcontrol/WheelLayout.h"

#include <cmath>

namespace hermes::motorcontrol {
namespace {

double inverseOrZero(double square) {
    return square > 0 ? 1 / square : 0;
}

} // namespace

WheelLayout::WheelLayout(double radius, const std::array<Twist2D, wheelCount> &rows)
    : radius_(radius)
    , rows_(rows) {
    Twist2D squares;
    for (const Twist2D &row : rows_) {
        squares.vx += row.vx * row.vx;
        squares.vy += row.vy * row.vy;
        squares.omega += row.omega * row.omega;
    }
    inverseSquares_ = {inverseOrZero(squares.vx), inverseOrZero(squares.vy), inverseOrZero(squares.omega)};
}

WheelLayout WheelLayout::mecanum(const WheelGeometry &geometry) {
    const double lever = geometry.halfBase + geometry.halfTrack;
    return {geometry.radius, {{{1, -1, -lever}, {1, 1, lever}, {1, 1, -lever}, {1, -1, lever}}}};
}

WheelLayout WheelLayout::differential(const WheelGeometry &geometry) {
    const double lever = geometry.halfTrack;
    return {geometry.radius, {{{1, 0, -lever}, {1, 0, lever}, {1, 0, -lever}, {1, 0, lever}}}};
}

WheelValues WheelLayout::wheelSpeeds(const Twist2D &twist) const {
    WheelValues speeds{};
    for (int i = 0; i < wheelCount; ++i) {
        const Twist2D &row = rows_[i];
        speeds[i] = (row.vx * twist.vx + row.vy * twist.vy + row.omega * twist.omega) / radius_;
    }
    return speeds;
}

Twist2D WheelLayout::twist(const WheelValues &speeds) const {
    Twist2D sum;
    for (int i = 0; i < wheelCount; ++i) {
        sum.vx += rows_[i].vx * speeds[i];
        sum.vy += rows_[i].vy * speeds[i];
        sum.omega += rows_[i].omega * speeds[i];
    }
    return {radius_ * inverseSquares_.vx * sum.vx, radius_ * inverseSquares_.vy * sum.vy,
            radius_ * inverseSquares_.omega * sum.omega};
}

double WheelLayout::slip(const WheelValues &speeds) const {
    const WheelValues rigid = wheelSpeeds(twist(speeds));
    double sum = 0;
    for (int i = 0; i < wheelCount; ++i)
        sum += (speeds[i] - rigid[i]) * (speeds[i] - rigid[i]);
    return radius_ * std::sqrt(sum / wheelCount);
}

} // namespace hermes::motorcontrol
