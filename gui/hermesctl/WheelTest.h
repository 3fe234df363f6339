#pragma once

#include "gui/hermesctl/Arguments.h"

#include "common/client/Client.h"

#include <map>

namespace hermes::ctl {

/// The wheels by the names of settings and commands, in their order.
const QStringList &wheelNames();

/// What a person has seen when a wheel was told to turn forward.
struct SeenWheel {
    QString wheel; ///< that turned; empty: none
    bool isBackward = false;
};

/// "": as told; "b": backward; "fl", "fr", "rl", "rr": that one instead, with a "b" behind it backward; "n":
/// none. Nothing for all else.
std::optional<SeenWheel> seenWheel(const QString &told, const QString &answer);

/// The settings `wheels` of the motor control that make each wheel turn when and as it is told, from those of
/// now and what was seen of each. Error: no wheel or one wheel more than once turned.
Result<QJsonObject> wheelSettings(const QJsonObject &now, const std::map<QString, SeenWheel> &seen);

/// Turns each wheel slowly for a second and asks what a person has seen; gives the settings `wheels` that are
/// to change. The robot stands when it is back. Error: the test was given up.
Result<QJsonObject> testWheels(Client &motors, const Arguments &arguments);

} // namespace hermes::ctl
