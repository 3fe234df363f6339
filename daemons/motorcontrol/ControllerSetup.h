#pragma once

#include "daemons/motorcontrol/ControllerReadings.h"
#include "daemons/motorcontrol/MotorSettings.h"

namespace hermes::motorcontrol {

/// What a controller is told and asked before it may drive: its version, the serial time-out and the PID of
/// both motors, which are written and read back, and every slow reading, once.
class ControllerSetup {
public:
    void configure(const MotorSettings &settings);
    /// Whether these settings ask for another set-up than it makes.
    bool differs(const MotorSettings &settings) const;
    void restart() { step_ = 0; }

    bool isDone() const { return step_ == steps; }
    roboclaw::Request request(quint8 address) const;
    /// Takes the answer to request() and goes on. Gives what is wrong with it, or an empty text.
    QString take(const roboclaw::Bus::Outcome &outcome, ControllerReadings &readings);

    /// Goes on without an answer to request().
    void skip() { ++step_; }

    double fullSpeed() const { return pid_.qpps; } ///< counts/s
    int timeoutTenths() const { return timeoutTenths_; }
    /// Seconds without a byte after which the controller stops by itself, as the settings have it.
    double timeout_s() const { return timeoutTenths_ / 10.0; }
    /// What is wrong with a time-out (0.1 s) that the controller tells, or an empty text.
    QString timeoutFault(qint64 tenths) const;
    /// "RoboClaw 2x45A v4.2.8"; empty until it was told.
    const QString &version() const { return version_; }

    static constexpr int settingSteps = 7, steps = settingSteps + ControllerReadings::slowCount;

private:
    QString fault(const roboclaw::Reply &reply) const;
    QString pidFault(int motor, const roboclaw::Reply &reply) const;

    VelocityPid pid_;
    int timeoutTenths_ = 2;
    int step_ = 0;
    QString version_;
};

} // namespace hermes::motorcontrol
