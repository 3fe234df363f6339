#pragma once

namespace hermes {

/// Velocity of the robot in its own frame: x forward, y left (m/s), omega counter-clockwise (rad/s).
struct Twist {
    double vx = 0;
    double vy = 0;
    double omega = 0;
};

} // namespace hermes
