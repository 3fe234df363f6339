#pragma once

#include "daemons/motorcontrol/Wheels.h"

namespace hermes::motorcontrol {

/// Sizes of the wheel frame in metres.
struct WheelGeometry {
    double radius = 0.1;     ///< of a wheel
    double halfBase = 0.25;  ///< from the centre to an axle, along x (l1 of the thesis)
    double halfTrack = 0.25; ///< from the centre to the middle of a wheel, along y (l2 of the thesis)
};

/// The linear map between the robot's velocity and the speeds of its wheels.
/// A layout is a matrix with orthogonal columns, one a degree of freedom; a further layout is one more of the
/// functions that make them.
class WheelLayout {
public:
    /// Rollers at 45 degrees whose axes form an X seen from above. Thesis eq. (4.1), whose wheels 1 to 4 are
    /// rear left, rear right, front left and front right when y points left.
    static WheelLayout mecanum(const WheelGeometry &geometry);
    /// Wheels of one side turn alike; vy is not possible and counts as 0. halfTrack is the effective one.
    static WheelLayout differential(const WheelGeometry &geometry);

    /// Inverse kinematics: rad/s.
    WheelValues wheelSpeeds(const Twist2D &twist) const;
    /// Forward kinematics: the twist that explains the speeds best (pseudo-inverse).
    Twist2D twist(const WheelValues &speeds) const;
    /// Root mean square, at the rim in m/s, of what no motion of a rigid robot explains: wheels that slip, or
    /// an encoder that lies.
    double slip(const WheelValues &speeds) const;
    bool movesSideways() const { return inverseSquares_.vy > 0; }

private:
    WheelLayout(double radius, const std::array<Twist2D, wheelCount> &rows);

    double radius_;
    std::array<Twist2D, wheelCount> rows_; // radius * wheel speed = row . twist
    Twist2D inverseSquares_;               // 1 / |column|^2, 0 for a column of zeros
};

} // namespace hermes::motorcontrol
