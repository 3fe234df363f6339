#pragma once

#include "daemons/motorcontrol/Wheels.h"

namespace hermes::motorcontrol {

/// Sizes of the wheel frame in metres and radians.
struct WheelGeometry {
    double radius = 0.1;          ///< of a wheel
    double halfBase = 0.25;       ///< from the centre to an axle, along x (l1 of the thesis)
    double halfTrack = 0.25;      ///< from the centre to the middle of a wheel, along y (l2 of the thesis)
    double omniRadius = 0.2;      ///< from the centre to a wheel of an omni layout
    double omniAngle = 1.0472;    ///< of its front left wheel, counter-clockwise from x
    double largestSteering = 0.4; ///< of a steered axle, both ways
};

/// The linear map between the robot's velocity and the speeds of its wheels.
/// A layout is a matrix with orthogonal columns, one a degree of freedom, and rows of zeros for wheels that
/// it has not; a further layout is one more of the functions that make them.
class WheelLayout {
public:
    /// Rollers at 45 degrees whose axes form an X seen from above. Thesis eq. (4.1), whose wheels 1 to 4 are
    /// rear left, rear right, front left and front right when y points left.
    static WheelLayout mecanum(const WheelGeometry &geometry);
    /// Wheels of one side turn alike; vy is not possible and counts as 0. halfTrack is the effective one.
    static WheelLayout differential(const WheelGeometry &geometry);
    /// The same with the front left and the front right wheel alone.
    static WheelLayout twoWheels(const WheelGeometry &geometry);
    /// Three or four wheels whose rollers turn across them, at even angles around the centre: front left,
    /// rear left, rear right (of four) and front right, counter-clockwise. So turn positive wheels the robot.
    static WheelLayout omni(const WheelGeometry &geometry, int wheels);
    /// A steered axle in front of one that is driven, by a motor a wheel or by one (rear left) for both. The
    /// robot's centre is the middle of the driven axle; what it turns is told by the steering.
    static WheelLayout ackermann(const WheelGeometry &geometry, int motors);

    /// Inverse kinematics: rad/s.
    WheelValues wheelSpeeds(const Twist2D &twist) const;
    /// Forward kinematics: the twist that explains the speeds best (pseudo-inverse). steering: rad, to the
    /// left, of a steered axle.
    Twist2D twist(const WheelValues &speeds, double steering = 0) const;
    /// Root mean square, at the rim in m/s, of what no motion of a rigid robot explains: wheels that slip, or
    /// an encoder that lies.
    double slip(const WheelValues &speeds, double steering = 0) const;
    /// The largest speed of a wheel, rad/s, in any motion within these bounds.
    double largestSpeed(const Twist2D &bounds) const;

    bool has(int wheel) const;
    bool movesSideways() const { return inverseSquares_.vy > 0; }
    bool steers() const { return wheelBase_ > 0; }
    double largestSteering() const { return largestSteering_; }
    /// Metres of the tightest bend; 0 where it turns on the spot.
    double leastRadius() const;
    /// Of the way of a robot that steers, 1/m, to the left.
    double curvature(double steering) const;
    /// The inverse of it.
    double steering(double curvature) const;

private:
    using Rows = std::array<Twist2D, wheelCount>;
    WheelLayout(double radius, const Rows &rows);

    double radius_;
    Rows rows_;                                  // radius * wheel speed = row . twist
    Twist2D inverseSquares_;                     // 1 / |column|^2, 0 for a column of zeros
    double wheelBase_ = 0, largestSteering_ = 0; // of a robot that steers; m, rad
};

} // namespace hermes::motorcontrol
