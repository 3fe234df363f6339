#pragma once

#include "protocol/messages/Daemons.h"

#include <optional>

namespace hermes {

/// HERMES_ROBOT="ID NAME" of the environment tells a process of which robot it is: a supervisor sets it for
/// those that it starts.
constexpr const char *robotVariable = "HERMES_ROBOT";
constexpr int longestRobotName = 100; // characters

/// What that variable tells; nothing where it is not set, or where its id is no UUID or its name is empty,
/// too long or not printable.
std::optional<RobotIdentity> ownRobot();

/// Of this process and of those that it starts from now on. What of the name cannot be told is left out.
void setOwnRobot(const RobotIdentity &robot);

/// A UUID as text of 36 characters.
bool isRobotId(const QString &text);

} // namespace hermes
