#pragma once

#include "daemons/motorcontrol/FaultWatch.h"
#include "daemons/motorcontrol/WheelTracker.h"

#include <memory>

namespace hermes::motorcontrol {

/// The work of a cycle: set-points for the controllers, motion from their readings, faults. Knows no clock,
/// no thread and no line; times are monotonic.
class DriveEngine {
public:
    explicit DriveEngine(const MotorSettings &settings);

    /// New settings, except those of the lines. Halts.
    void configure(const MotorSettings &settings);
    /// From now on the robot may not move.
    void retire(const QString &why);

    void cycle(double now);
    /// After a command or configure(): a halt is given to the controllers at once. True when there is one.
    bool obey();
    /// Gives a stand to the controllers, whatever they were told before.
    void stand() { command({}); }
    /// All that are ready have acknowledged their set-point, and the others were told to stand.
    bool hasObeyed() const;

    Drive &drive() { return drive_; }
    Odometry &odometry() { return odometry_; }
    MotorController &controller(int index) { return *controllers_[size_t(index)]; }
    int controllers() const { return int(controllers_.size()); }
    /// Of the last cycle, with what has changed since; the owner adds what it knows of lines, clock and
    /// thread.
    Telemetry &report();

private:
    void updateReadiness();
    void judgeObedience();
    void takeReadings();
    void trackWheels(double now);
    void command(const WheelValues &setPoint);

    MotorSettings settings_;
    Drive drive_;
    Odometry odometry_;
    WheelTracker tracker_;
    FaultWatch faults_;
    std::vector<std::unique_ptr<MotorController>> controllers_;
    Telemetry telemetry_;
    WheelValues sent_{}; // the set-point of the last cycle
    /// Of a steered axle, rad: of the last cycle, and what it was while the readings of the next one came.
    double steering_ = 0, steered_ = 0;
    quint64 resets_ = 0; // of the drive, seen
    bool retired_ = false;
};

} // namespace hermes::motorcontrol
