#pragma once

#include "protocol/messages/Motors.h"

#include <array>

namespace hermes::motorcontrol {

enum class Wheel { FrontLeft, FrontRight, RearLeft, RearRight };

constexpr int wheelCount = WheelsMessage::count;
/// As in settings, commands and topics, in the order of Wheel.
constexpr auto wheelNames = WheelsMessage::names;

/// One number a wheel, in the order of Wheel. Positive turns drive the robot forward, on both sides.
using WheelValues = std::array<double, wheelCount>;

} // namespace hermes::motorcontrol
