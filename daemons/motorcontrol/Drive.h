#pragma once

#include "common/Result.h"
#include "daemons/motorcontrol/CommandWatchdog.h"
#include "daemons/motorcontrol/ControlLease.h"
#include "daemons/motorcontrol/MotionLimits.h"
#include "daemons/motorcontrol/StopLatch.h"

namespace hermes::motorcontrol {

/// Whether and how fast the wheels turn: who may command, what is within the limits, and every reason to
/// stop. Knows no devices; times are seconds of a clock that never jumps. Use from one thread.
///
/// A halt makes the set-point zero at once, without the limits of acceleration: the controllers brake with
/// the emergency deceleration.
class Drive {
public:
    struct Settings {
        WheelLayout layout = WheelLayout::mecanum(WheelGeometry());
        MotionLimits limits;
        double commandTimeout_s = 0.25; ///< without a command for so long the robot halts
        bool rearAsFront = false;       ///< each wheel behind turns with the one before it
    };

    /// Halts.
    void configure(const Settings &settings);

    // Commands. Errors: InvalidParams (not finite), OverLimit (data.errors), NotReady (emergency stop,
    // controllers not ready, command too old), DeviceFault (a fault is latched), ControlHeld.
    /// age_s: how old the command is, 0 where unknown; the time-out counts from when it was made. Older than
    /// the time-out is refused, and so is one that comes from a future as far away.
    Result<void> driveTwist(quint64 client, const Twist2D &twist, double age_s, double now);
    Result<void> driveWheels(quint64 client, const WheelValues &speeds, double age_s, double now);
    /// Anyone may stop. Ends the lease unless the client holds it. Who lost it so does not change the reason.
    void stop(quint64 client, const QString &who);
    /// who: as others are to know it. The client is the one that may release it.
    void emergencyStop(quint64 client, const QString &who, double now);
    /// One of before the start: only a person may release it.
    void restoreStop(const QString &reason, double now);
    /// Whether this client may release the emergency stop. Within holdOff_s of the last press nobody may,
    /// then who alone pressed it, or for whom a person has confirmed; never one that was driving when another
    /// pressed it. Error: NotReady, with data.retry_after_s or data.confirm where that would help.
    Result<void> mayReset(quint64 client, bool isConfirmed, double now) const;
    /// Releases the emergency stop and the faults. What still is wrong latches again.
    /// who: as others are to know it; empty: nobody says.
    void resetEmergencyStop(const QString &who = {});
    /// How often that was done.
    quint64 resets() const { return resets_; }
    Result<void> acquire(quint64 client, const QString &name, double timeout_s, double now, double age_s = 0);
    /// Takes the control from whoever holds it, and halts when that is another client.
    Result<void> takeOver(quint64 client, const QString &name, double timeout_s, double now,
                          double age_s = 0);
    void release(quint64 client);
    /// Tells the holder that this client would like to have the control.
    void ask(quint64 client, const QString &name);
    void clientGone(quint64 client);
    /// The program stood still, as text says: whoever held the control may know nothing of it. Halts, and
    /// ends the lease.
    void stoodStill(const QString &text);

    // What the devices tell.
    /// Latches until resetEmergencyStop(). True when it is new.
    bool fault(const QString &name, const QString &reason);
    void setReady() { notReady_.clear(); }
    /// The wheels cannot be commanded; halts, and ends the lease. why is for messages.
    void setNotReady(const QString &why, const QString &cause = "controller");

    /// The speeds (rad/s) that the wheels shall have now, once a cycle.
    const WheelValues &step(double now);

    const WheelValues &setPoint() const { return setPoint_; }
    const WheelValues &target() const { return target_; }
    /// Of a steered axle, rad to the left: what it shall have now, and then. A halt leaves it as it is: the
    /// robot brakes on its way.
    double steering() const { return steering_; }
    double targetSteering() const { return targetSteering_; }
    const StopLatch &latch() const { return latch_; }
    const ControlLease &lease() const { return lease_; }
    /// Why the robot halted last; empty while it follows commands.
    const QString &haltReason() const { return haltReason_; }
    /// The same in a word, for programs: what MotionHold::cause lists.
    const QString &haltCause() const { return haltCause_; }

    static constexpr const char *emergencyCause = "estop";
    static constexpr double holdOff_s = 2; ///< after a press

private:
    Result<void> mayMove(double age_s) const;
    Result<void> accept(quint64 client, const WheelValues &target, double age_s, double now);
    void halt(const QString &cause, const QString &reason);
    void depose();
    void advance(double dt);

    Settings settings_;
    CommandWatchdog watchdog_;
    ControlLease lease_;
    StopLatch latch_;
    WheelValues target_{}, setPoint_{};
    double targetSteering_ = 0, steering_ = 0;
    bool turnsWheels_ = false; // each with its own speed: no motion of the robot
    QString notReady_ = "the controllers have not answered yet";
    QString haltCause_, haltReason_;
    /// Of the emergency stop. 0: several pressed it, or nobody that is known; nobody drove.
    quint64 presser_ = 0, stopped_ = 0;
    double pressed_ = 0;  // the last time
    quint64 deposed_ = 0; // from whom another took the control by a stop
    quint64 resets_ = 0;
    double lastStep_ = 0;
};

} // namespace hermes::motorcontrol
