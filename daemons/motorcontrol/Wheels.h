#pragma once

#include "protocol/messages/Motors.h"

#include <array>

namespace hermes::motorcontrol {

enum class Wheel { FrontLeft, FrontRight, RearLeft, RearRight };

using hermes::wheelCount;
using hermes::wheelNames; // in the order of Wheel

/// One number a wheel, in the order of Wheel. Positive turns drive the robot forward, on both sides.
using WheelValues = std::array<double, wheelCount>;

} // namespace hermes::motorcontrol
