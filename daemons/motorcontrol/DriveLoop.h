#pragma once

#include "common/daemon/Command.h"
#include "daemons/motorcontrol/ControllerLine.h"
#include "daemons/motorcontrol/CycleTimer.h"
#include "daemons/motorcontrol/DriveEngine.h"
#include "daemons/motorcontrol/DriveMail.h"

#include <chrono>

namespace hermes::motorcontrol {

/// The cycle that drives the motors, in a thread of its own, so that nothing that clients do delays it. All
/// functions must be called in that thread. Writes no log: that may wait for whoever reads it.
class DriveLoop : public QObject {
    Q_OBJECT
public:
    static constexpr std::chrono::milliseconds period{20};

    /// Reports after each cycle and after the jobs of the mail, which must outlive it.
    DriveLoop(const MotorSettings &settings, DriveMail &mail);

    /// Opens the lines and begins. Error: a URL that names no line, no timer.
    Result<void> start();
    /// New settings, except those of the lines. Halts.
    void configure(const MotorSettings &settings);
    /// Brings the wheels to a stand; then, or when the controllers do not answer in time, calls done.
    void shutDown(std::function<void()> done);

    /// What jobs act upon. A halt goes out when the job ends, without waiting for the next cycle.
    Drive &drive() { return engine_.drive(); }
    Odometry &odometry() { return engine_.odometry(); }
    const Telemetry &telemetry() { return engine_.report(); }
    /// What came before this is void: a stop overtook it, or the loop stood still. Of the clock of bootNow().
    /// Whether a call came before a stop, or may have: of others than who stopped what lay unread then, too.
    bool isVoid(const Call &call) const {
        return (call.client == stopper_ ? call.time : call.earliest) <= voidUntil_;
    }
    /// What came before this stop is void.
    void makeVoid(const Call &stop) {
        voidUntil_ = std::max(voidUntil_, stop.time);
        stopper_ = stop.client;
    }

private:
    Result<void> openLines();
    void lookForGap();
    void doJobs();
    void cycle();
    void wakeLines();
    void report();

    MotorSettings settings_; // those of the lines
    DriveMail &mail_;
    DriveEngine engine_;
    std::vector<ControllerLine *> lines_;
    std::array<ControllerLine *, controllerCount> lineOf_{};
    CycleTimer timer_;
    double longestGap_s_;
    double lastLook_ = 0, voidUntil_ = 0;
    quint64 stopper_ = 0; // a client; 0: none
    std::unique_ptr<QSocketNotifier> jobs_;
    std::function<void()> done_; // shutting down
    double doneLatest_ = 0;
};

} // namespace hermes::motorcontrol
