#pragma once

#include "protocol/messages/Motion.h"

#include <array>

namespace hermes::motorcontrol {

enum class Wheel { FrontLeft, FrontRight, RearLeft, RearRight };

constexpr int wheelCount = 4;
/// As in settings, commands and topics, in the order of Wheel.
constexpr std::array<const char *, wheelCount> wheelNames{"front_left", "front_right", "rear_left",
                                                          "rear_right"};

/// One number a wheel, in the order of Wheel. Positive turns drive the robot forward, on both sides.
using WheelValues = std::array<double, wheelCount>;

} // namespace hermes::motorcontrol
