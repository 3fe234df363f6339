#pragma once

#include "daemons/motorcontrol/Telemetry.h"

namespace hermes {

OdometryMessage odometryOf(const Telemetry &telemetry);
/// The data of the topic wheels: {front_left: {target, set_point, speed, angle}, ..., slip}.
QJsonObject wheelsJson(const Telemetry &telemetry);
/// The data of the topic power: {controllers: [...]}.
QJsonObject powerJson(const Telemetry &telemetry);
/// Readings, health and traffic of one controller.
QJsonObject controllerJson(const Telemetry::Controller &controller);
/// {period_s, cycles, missed, mean_lateness_s, worst_lateness_s, realtime}
QJsonObject cycleJson(const Telemetry &telemetry, double period_s);
QJsonObject toJson(const Pose &pose);
QJsonObject toJson(const Twist &twist);

/// Whether every controller has confirmed that it stands.
bool allStand(const Telemetry &t);
/// {confirmed, text, controllers: [{name, confirmed, reason}]}: the answer to a stop.
QJsonObject standingJson(const Telemetry &t);
/// Which controllers have not confirmed that they stand, and why; empty when all have.
QString notConfirmedText(const Telemetry &t);

} // namespace hermes
