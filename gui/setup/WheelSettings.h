#pragma once

#include "common/Result.h"

#include <QJsonObject>
#include <QStringList>
#include <map>

namespace hermes {

/// The wheels by the names of settings and commands, in their order.
const QStringList &wheelNames();

/// What a test of the wheels turns.
struct WheelPlan {
    QJsonObject settings; ///< `wheels`, of now
    QStringList wheels;   ///< one after the other
    double speed = 1;     ///< rad/s: more than 1 where a wheel so slow may stand still

    /// From all settings of a motor control and what motor.state answers. Error: it has no wheels, or they
    /// have no "forward" that a person could see: they are omni wheels.
    static Result<WheelPlan> from(const QJsonObject &settings, const QJsonObject &state);
};

/// What a person has seen when a wheel was told to turn forward.
struct SeenWheel {
    QString wheel; ///< that turned; empty: none
    bool isBackward = false;
};

/// The settings `wheels` of the motor control that make each wheel turn when and as it is told, from those of
/// now and what was seen of each. Error: no wheel or one wheel more than once turned.
Result<QJsonObject> wheelSettings(const QJsonObject &now, const std::map<QString, SeenWheel> &seen);

} // namespace hermes
