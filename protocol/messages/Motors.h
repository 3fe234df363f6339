#pragma once

#include "protocol/messages/Motion.h"

#include <QMap>
#include <QString>
#include <array>
#include <optional>
#include <vector>

namespace hermes {

/// Who may move the robot.
struct LeaseState {
    bool held = false;
    std::optional<QString> holder;
    double remaining_s = 0;
    std::optional<QString> wanted; ///< who asked the holder for it last
};

/// What keeps the robot from following a client's commands: the topic `control`, and a part of motor.state.
struct MotionHold {
    QMap<QString, QString> latched; ///< cause: reason
    LeaseState control;
    QString halted; ///< why the robot halted last; empty while it follows commands
    /// The same in a word: driver (who drove stopped), stop (others did), estop, time-out (of commands, or of
    /// the control), take-over, client gone, release, reset, settings, gap (the program stood still),
    /// shutdown, controller (one is not ready), or the fault that is latched: battery, current, temperature,
    /// encoder, controller_1, controller_2.
    QString cause;
};

/// Whether the robot is known to stand: a part of what motor.stop and motor.estop answer, and of
/// motor.state.standing.
struct StandConfirmation {
    bool confirmed = false;
    QString text; ///< which controllers have not, and why
};

/// What a motor controller measures of its power.
struct ControllerPower {
    bool ready = false;
    double battery_v = 0, logic_v = 0;
    std::array<double, 2> current_a{};
    double temperature_c = 0;
    quint32 status = 0;
    QStringList statusTexts;
    std::optional<std::array<double, 2>> duty; ///< nothing: it does not tell it
};

/// How full the battery is: a part of the topic `power` and of motor.state. What is not known is missing.
struct BatteryState {
    std::optional<double> charge, chargeDeviation; ///< shares of the capacity
    std::optional<double> current_a;               ///< of motors (smoothed), computers and sensors
    std::optional<double> left_s, leftLeast_s;     ///< at that current, until only the reserve is left
    QString reason;                                ///< why not all is known; else empty
};

/// The topic `power`.
struct PowerMessage {
    std::vector<ControllerPower> controllers;
    BatteryState battery;
};

/// A wheel of the topic `wheels`: rad/s, angle in rad.
struct WheelMessage {
    double target = 0, setPoint = 0, speed = 0, angle = 0;
};

/// The topic `wheels`, with those that the layout has.
struct WheelsMessage {
    static constexpr int count = 4;
    static constexpr std::array<const char *, count> names{"front_left", "front_right", "rear_left",
                                                           "rear_right"};

    std::optional<WheelMessage> frontLeft, frontRight, rearLeft, rearRight;
    std::optional<double> steering; ///< rad
    double slip = 0;
    Twist2D target; ///< of the robot

    /// In the order of their names.
    static constexpr std::array<std::optional<WheelMessage> WheelsMessage::*, count> wheels() {
        return {&WheelsMessage::frontLeft, &WheelsMessage::frontRight, &WheelsMessage::rearLeft,
                &WheelsMessage::rearRight};
    }
};

Fields<LeaseState> fieldsOf(Of<LeaseState>);
Fields<MotionHold> fieldsOf(Of<MotionHold>);
Fields<StandConfirmation> fieldsOf(Of<StandConfirmation>);
Fields<ControllerPower> fieldsOf(Of<ControllerPower>);
Fields<BatteryState> fieldsOf(Of<BatteryState>);
Fields<PowerMessage> fieldsOf(Of<PowerMessage>);
Fields<WheelMessage> fieldsOf(Of<WheelMessage>);
Fields<WheelsMessage> fieldsOf(Of<WheelsMessage>);

} // namespace hermes
