#pragma once

#include "daemons/motorcontrol/BatteryGauge.h"
#include "daemons/motorcontrol/Telemetry.h"
#include "protocol/messages/Motors.h"

namespace hermes::motorcontrol {

/// Whether all controllers have confirmed that they stand: the answer to a stop.
struct Standing {
    struct Controller {
        QString name;
        bool confirmed = false;
        QString reason; ///< why not
    };
    StandConfirmation all;
    std::vector<Controller> controllers;
};

/// How punctual the drive loop is.
struct CycleState {
    double period_s = 0;
    CycleStatistics statistics;
    quint64 unread = 0;
    bool realtime = false;
};

/// What motor.state gives.
struct MotorState {
    bool ready = false;
    Standing standing;
    bool estop = false;
    MotionHold hold;
    Pose2D pose;
    Twist2D twist, target, setPoint;
    WheelsMessage wheels;
    quint64 counterJumps = 0;
    std::optional<double> longestWay_m;
    bool movesSideways = false;
    double leastRadius_m = 0;
    std::vector<Telemetry::Controller> controllers;
    CycleState cycle;
    BatteryState battery;
};

OdometryMessage odometryOf(const Telemetry &telemetry);
WheelsMessage wheelsOf(const Telemetry &telemetry, const WheelLayout &layout);
PowerMessage powerOf(const Telemetry &telemetry, const BatteryState &battery);
/// Of controllers that have all told all; else the reason.
Result<BatteryReading> batteryOf(const Telemetry &telemetry);
MotionHold holdOf(const Telemetry &telemetry);
CycleState cycleOf(const Telemetry &telemetry);
Standing standingOf(const Telemetry &telemetry);
/// Whether every controller has confirmed that it stands.
bool allStand(const Telemetry &telemetry);
/// Which controllers answer and are not known to stand; empty when none.
QString turningOf(const Telemetry &telemetry);

Fields<Standing::Controller> fieldsOf(Of<Standing::Controller>);
Fields<Standing> fieldsOf(Of<Standing>);
Fields<CycleState> fieldsOf(Of<CycleState>);
Fields<Telemetry::Controller> fieldsOf(Of<Telemetry::Controller>);
Fields<MotorState> fieldsOf(Of<MotorState>);

} // namespace hermes::motorcontrol
