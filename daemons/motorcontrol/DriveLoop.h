#pragma once

#include "daemons/motorcontrol/ControllerLine.h"
#include "daemons/motorcontrol/CycleTimer.h"
#include "daemons/motorcontrol/FaultWatch.h"
#include "daemons/motorcontrol/WheelTracker.h"

#include <chrono>
#include <memory>

namespace hermes {

/// The cycle that drives the motors, in a thread of its own, so that nothing that clients do delays it. All
/// functions must be called in that thread.
class DriveLoop : public QObject {
    Q_OBJECT
public:
    static constexpr std::chrono::milliseconds period{20};

    /// Called in the thread, after each cycle and after obey().
    using Listener = std::function<void(const Telemetry &)>;

    explicit DriveLoop(Listener listener);

    /// Opens the lines and begins. Error: a URL that names no line, no timer.
    Result<void> start(const MotorSettings &settings);
    /// New settings, except those of the lines. Halts.
    void configure(const MotorSettings &settings);
    /// Brings the wheels to a stand; then, or when the controllers do not answer in time, calls done.
    void shutDown(std::function<void()> done);

    /// What commands act upon; afterwards call obey().
    Drive &drive() { return drive_; }
    Odometry &odometry() { return odometry_; }
    /// Sends a halt at once, without waiting for the next cycle, and reports.
    void obey();

private:
    Result<void> openLines();
    void cycle();
    void takeReadings(double now);
    void updateReadiness();
    void send(const WheelValues &setPoint);
    void report();

    Listener listener_;
    MotorSettings settings_;
    Drive drive_;
    Odometry odometry_;
    WheelTracker tracker_;
    FaultWatch faults_;
    std::vector<std::unique_ptr<MotorController>> controllers_;
    std::vector<ControllerLine *> lines_;
    std::array<ControllerLine *, controllerCount> lineOf_{};
    CycleTimer timer_;
    Telemetry telemetry_;
    WheelValues sent_{};         // the set-point of the last cycle
    std::function<void()> done_; // shutting down
    double doneLatest_ = 0;
};

} // namespace hermes
