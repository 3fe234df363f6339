#pragma once

#include "common/settings/Settings.h"
#include "daemons/motorcontrol/BatteryGauge.h"
#include "daemons/motorcontrol/DeviceModels.h"
#include "daemons/motorcontrol/Drive.h"
#include "daemons/motorcontrol/EncoderMonitor.h"
#include "daemons/motorcontrol/Odometry.h"
#include "daemons/motorcontrol/Threshold.h"
#include "protocol/roboclaw/Command.h"

#include <algorithm>

namespace hermes::motorcontrol {

/// Where one motor controller is, and what.
struct ControllerAddress {
    QString url;                          ///< of its serial line; controllers with the same one share it
    int address = roboclaw::firstAddress; ///< where its kind has one
    const DeviceModel *model = &deviceModels().front();
};

/// Which motor turns a wheel.
struct WheelMount {
    int controller = 0; ///< from 0
    int motor = 0;      ///< 0: M1, 1: M2
    double sign = 1;    ///< -1 where positive counts drive the robot backward; 0: there is no such wheel

    static constexpr WheelMount none() { return {0, 0, 0}; }
};

/// The settings of hermes-motorcontrol as its parts use them.
struct MotorSettings {
    Drive::Settings drive;
    OdometryNoise odometry;
    /// Each turns a wheel.
    std::vector<ControllerAddress> controllers{{roboclaw::usualLine, roboclaw::firstAddress},
                                               {roboclaw::usualLine, roboclaw::firstAddress + 1}};
    bool areOthersSet =
        false; ///< than the controllers above, which were opened: they wait for the next start
    std::array<WheelMount, wheelCount> wheels;
    double countsPerTurn = 38000; ///< of a wheel
    double wheelRadius = 0.1, halfTrack = 0.25;
    double servoCentre = 0.5, servoPerRadian = 1; ///< of a steered axle: position, 0 to 1
    drive::VelocityPid pid;
    double serialTimeout_s = 0.2;        ///< after which the controllers stop by themselves
    bool mayLackTimeout = false;         ///< they may be such that never do
    double brake_a = 5, leastErpm = 900; ///< see drive::DeviceSettings
    double emergencyDeceleration = 4;    ///< m/s^2 at the rim
    Threshold::Settings battery{23, 21.5}, current{30, 45}, temperature{70, 85}; ///< V, A, degrees Celsius
    EncoderMonitor::Settings encoder{0.5, 0.25, 0.7};
    BatteryGauge::Settings gauge;
    double batteryWarning_s = 600;

    /// From settings that declareMotorSettings() has declared.
    static MotorSettings from(const Settings &settings);
    /// The same, with those that wait for the next start as if it had been.
    static MotorSettings withWaiting(const Settings &settings);
    /// The position of the servo at this angle, rad to the left; nothing where no axle is steered.
    std::optional<double> servoAt(double steering) const {
        if (!drive.layout.steers())
            return std::nullopt;
        return std::clamp(servoCentre + servoPerRadian * steering, 0.0, 1.0);
    }
    drive::DeviceSettings device() const {
        return {pid,       serialTimeout_s, mayLackTimeout, brake_a,
                leastErpm, countsPerTurn,   wheelRadius,    halfTrack};
    }
    /// Of their controllers, from the largest speed: how far the robot goes on when this program dies; where
    /// they roll, at least.
    double longestWay_m(double timeout_s) const {
        const Twist2D &most = drive.limits.velocity;
        const double speed = drive.layout.movesSideways() ? std::max(most.vx, most.vy) : most.vx;
        return speed * (timeout_s + speed / emergencyDeceleration);
    }
};

void declareMotorSettings(Settings &settings);
/// What the settings demand of one another.
std::vector<SchemaViolation> checkMotorSettings(const QJsonObject &settings);

} // namespace hermes::motorcontrol
