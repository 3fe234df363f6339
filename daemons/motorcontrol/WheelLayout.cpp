#include "daemons/motorcontrol/WheelLayout.h"

#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {
namespace {

double inverseOrZero(double square) {
    return square > 0 ? 1 / square : 0;
}

} // namespace

WheelLayout::WheelLayout(double radius, const Rows &rows)
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

WheelLayout WheelLayout::twoWheels(const WheelGeometry &geometry) {
    return {geometry.radius, {{{1, 0, -geometry.halfTrack}, {1, 0, geometry.halfTrack}}}};
}

WheelLayout WheelLayout::omni(const WheelGeometry &geometry, int wheels) {
    const std::array around{Wheel::FrontLeft, Wheel::RearLeft, Wheel::RearRight, Wheel::FrontRight};
    Rows rows;
    for (int i = 0; i < wheels; ++i) {
        const double angle = geometry.omniAngle + 2 * vectorlib::pi * i / wheels;
        const Wheel wheel = i + 1 < wheels ? around[std::size_t(i)] : Wheel::FrontRight;
        rows[std::size_t(wheel)] = {-std::sin(angle), std::cos(angle), geometry.omniRadius};
    }
    return {geometry.radius, rows};
}

WheelLayout WheelLayout::ackermann(const WheelGeometry &geometry, int motors) {
    const double lever = geometry.halfTrack;
    Rows rows;
    rows[std::size_t(Wheel::RearLeft)] = {1, 0, motors > 1 ? -lever : 0};
    if (motors > 1)
        rows[std::size_t(Wheel::RearRight)] = {1, 0, lever};
    WheelLayout layout(geometry.radius, rows);
    layout.wheelBase_ = 2 * geometry.halfBase;
    layout.largestSteering_ = geometry.largestSteering;
    return layout;
}

bool WheelLayout::has(int wheel) const {
    const Twist2D &row = rows_[std::size_t(wheel)];
    return row.vx != 0 || row.vy != 0 || row.omega != 0;
}

double WheelLayout::curvature(double steering) const {
    return std::tan(steering) / wheelBase_;
}

double WheelLayout::steering(double curvature) const {
    return std::atan(curvature * wheelBase_);
}

double WheelLayout::leastRadius() const {
    return steers() ? 1 / curvature(largestSteering_) : 0;
}

WheelValues WheelLayout::wheelSpeeds(const Twist2D &twist) const {
    WheelValues speeds{};
    for (int i = 0; i < wheelCount; ++i) {
        const Twist2D &row = rows_[i];
        speeds[i] = (row.vx * twist.vx + row.vy * twist.vy + row.omega * twist.omega) / radius_;
    }
    return speeds;
}

Twist2D WheelLayout::twist(const WheelValues &speeds, double steering) const {
    Twist2D sum;
    for (int i = 0; i < wheelCount; ++i) {
        sum.vx += rows_[i].vx * speeds[i];
        sum.vy += rows_[i].vy * speeds[i];
        sum.omega += rows_[i].omega * speeds[i];
    }
    const double vx = radius_ * inverseSquares_.vx * sum.vx;
    return {vx, radius_ * inverseSquares_.vy * sum.vy,
            steers() ? vx * curvature(steering) : radius_ * inverseSquares_.omega * sum.omega};
}

double WheelLayout::slip(const WheelValues &speeds, double steering) const {
    const WheelValues rigid = wheelSpeeds(twist(speeds, steering));
    double sum = 0;
    int wheels = 0;
    for (int i = 0; i < wheelCount; ++i) {
        sum += (speeds[i] - rigid[i]) * (speeds[i] - rigid[i]);
        wheels += has(i);
    }
    return radius_ * std::sqrt(sum / wheels);
}

double WheelLayout::largestSpeed(const Twist2D &bounds) const {
    double largest = 0;
    for (const Twist2D &row : rows_)
        largest = std::max(largest, std::abs(row.vx) * bounds.vx + std::abs(row.vy) * bounds.vy +
                                        std::abs(row.omega) * bounds.omega);
    return largest / radius_;
}

} // namespace hermes::motorcontrol
