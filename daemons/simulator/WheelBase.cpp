#include "daemons/simulator/WheelBase.h"

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Vector2D.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <initializer_list>

namespace hermes::simulator {
namespace {

using Point = vectorlib::Vector2D<double>;

constexpr double grip = 1e4; // of a tyre across its way, against one that rolls

/// What the touching points say of the motion of the body: each moves along one direction with a known speed.
class Contacts {
public:
    void add(Point at, Point along, double speed, double weight = 1) {
        const Eigen::Vector3d row(along.x, along.y, at.x * along.y - at.y * along.x);
        squares_ += weight * row * row.transpose();
        sum_ += weight * speed * row;
    }
    Twist2D motion() const {
        const Eigen::Vector3d twist = squares_.ldlt().solve(sum_);
        return {twist[0], twist[1], twist[2]};
    }

private:
    Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
};

Point unit(double angle) {
    return {std::cos(angle), std::sin(angle)};
}

} // namespace

Twist2D WheelBase::twistOf(const std::array<double, 4> &wheels, double servo) const {
    const Point ahead{1, 0}, left{0, 1}, centre{0, 0};
    const auto corner = [this](int wheel) {
        return Point{wheel < 2 ? halfBase : -halfBase, wheel % 2 == 0 ? halfTrack : -halfTrack};
    };
    const auto rim = [&](int wheel) { return radius * wheels[std::size_t(wheel)]; };
    Contacts contacts;
    const auto roll = [&](int wheel) { contacts.add(corner(wheel), ahead, rim(wheel)); };
    const auto rollAround = [&](std::initializer_list<int> order) {
        double angle = omniAngle;
        for (const int wheel : order) {
            contacts.add(unit(angle) * omniRadius, unit(angle + vectorlib::pi / 2), rim(wheel));
            angle += 2 * vectorlib::pi / double(order.size());
        }
    };
    switch (kind) {
    case Kind::Mecanum: // a roller that touches the ground slips across its axle, and nowhere else
        for (const int i : {0, 1, 2, 3}) {
            const Point axle = unit(i == 0 || i == 3 ? -vectorlib::pi / 4 : vectorlib::pi / 4);
            contacts.add(corner(i), axle, rim(i) * axle.x);
        }
        break;
    case Kind::Differential: // in a turn those in front and those behind are dragged aside alike
        roll(2), roll(3);
        [[fallthrough]];
    case Kind::TwoWheels:
        roll(0), roll(1);
        contacts.add(centre, left, 0);
        break;
    case Kind::Omni3:
        rollAround({0, 2, 1});
        break;
    case Kind::Omni4:
        rollAround({0, 2, 3, 1});
        break;
    case Kind::Ackermann:
        if (rearMotors == 1)
            contacts.add(centre, ahead, rim(2));
        else
            roll(2), roll(3);
        contacts.add(centre, left, 0, grip);
        contacts.add({2 * halfBase, 0}, unit((servo - servoCentre) / servoPerRadian + vectorlib::pi / 2), 0,
                     grip);
        break;
    }
    return contacts.motion();
}

} // namespace hermes::simulator
