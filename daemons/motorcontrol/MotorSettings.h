#pragma once

#include "common/settings/Settings.h"
#include "daemons/motorcontrol/BatteryGauge.h"
#include "daemons/motorcontrol/Drive.h"
#include "daemons/motorcontrol/EncoderMonitor.h"
#include "daemons/motorcontrol/Odometry.h"
#include "daemons/motorcontrol/Threshold.h"
#include "protocol/drive/MotorDevice.h"
#include "protocol/roboclaw/Command.h"

namespace hermes::motorcontrol {

constexpr int controllerCount = 2; ///< at most

enum class DeviceKind { RoboClaw, Arduino };

/// Where one motor controller is, and what.
struct ControllerAddress {
    QString url;                          ///< of its serial line; controllers with the same one share it
    int address = roboclaw::firstAddress; ///< of a RoboClaw
    DeviceKind kind = DeviceKind::RoboClaw;
};

/// Which motor turns a wheel.
struct WheelMount {
    int controller = 0; ///< 0 or 1
    int motor = 0;      ///< 0: M1, 1: M2
    double sign = 1;    ///< -1 where positive counts drive the robot backward
};

/// The settings of hermes-motorcontrol as its parts use them.
struct MotorSettings {
    Drive::Settings drive;
    OdometryNoise odometry;
    /// Two, or one with two motors: a wheel behind then turns as the one before it.
    std::vector<ControllerAddress> controllers{{roboclaw::usualLine, roboclaw::firstAddress},
                                               {roboclaw::usualLine, roboclaw::firstAddress + 1}};
    std::array<WheelMount, wheelCount> wheels;
    double countsPerTurn = 38000; ///< of a wheel
    double wheelRadius = 0.1;
    drive::VelocityPid pid;
    double serialTimeout_s = 0.2;     ///< after which the controllers stop by themselves
    double emergencyDeceleration = 4; ///< m/s^2 at the rim
    Threshold::Settings battery{23, 21.5}, current{30, 45}, temperature{70, 85}; ///< V, A, degrees Celsius
    EncoderMonitor::Settings encoder{0.5, 0.25, 0.7};
    BatteryGauge::Settings gauge;
    double batteryWarning_s = 600;

    /// From settings that declareMotorSettings() has declared.
    static MotorSettings from(const Settings &settings);
    /// Of their controllers, from the largest speed: how far the robot goes on when this program dies.
    double longestWay_m(double timeout_s) const {
        const double speed = drive.limits.velocity.vx;
        return speed * (timeout_s + speed / emergencyDeceleration);
    }
};

/// Calls declare for each setting, in the order in which people should see them.
void declareMotorSettings(const std::function<void(const Field &)> &declare);
/// What the settings demand of one another.
std::vector<SchemaViolation> checkMotorSettings(const QJsonObject &settings);

} // namespace hermes::motorcontrol
