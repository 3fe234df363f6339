#pragma once

#include "gui/hermesctl/Arguments.h"

#include "common/client/Client.h"
#include "gui/setup/WheelSettings.h"

#include <optional>

namespace hermes::ctl {

/// "": as told; "b": backward; "fl", "fr", "rl", "rr": that one instead, with a "b" behind it backward; "n":
/// none. Nothing for all else.
std::optional<SeenWheel> seenWheel(const QString &told, const QString &answer);

/// Turns each wheel slowly for a second and asks what a person has seen; gives the settings `wheels` that are
/// to change. The robot stands when it is back. Error: the test was given up.
Result<QJsonObject> testWheels(Client &motors, const Arguments &arguments);

} // namespace hermes::ctl
