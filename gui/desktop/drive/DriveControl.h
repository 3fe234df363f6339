#pragma once

#include "common/client/ClockOffset.h"
#include "gui/desktop/drive/DriveInputs.h"
#include "gui/desktop/drive/StopControl.h"
#include "gui/desktop/model/Sessions.h"
#include "gui/desktop/widgets/SecondPress.h"
#include "protocol/messages/Motion.h"
#include "protocol/messages/Motors.h"

#include <QElapsedTimer>

namespace hermes::desktop {

/// Drives the chosen robot: takes what stick, keys and gamepad request, asks for the control, sends motion
/// commands at 20 Hz with their time, and stops. Whatever ends a drive (released, focus lost, link lost,
/// a command refused, another robot chosen, STOP) ends it with a stop; then every input has to be at rest
/// before one counts again. While another client has the control nothing is sent to the motors but STOP.
class DriveControl : public QObject {
    Q_OBJECT
public:
    static constexpr std::chrono::milliseconds period{50};
    /// A key that is pressed again so soon was not let go: the keyboard repeats it.
    static constexpr std::chrono::milliseconds repeatGap{20};
    /// How long the control is kept without a command.
    static constexpr double lease_s = 1;

    explicit DriveControl(Fleet &fleet, QObject *parent = nullptr);

    /// What an input requests: each of the three from -1 to 1 of the largest speed. isHeld: its dead-man key
    /// or button is down; released it requests nothing.
    void steer(const QString &input, const Twist2D &request, bool isHeld);
    /// What the whole stick means, in m/s and rad/s. Nothing but setLimit() raises one; smaller largest
    /// speeds of the robot lower it.
    const Twist2D &limit() const { return limit_; }
    /// share: of the largest speeds, up to 1. False: something is held, so none was raised.
    bool setLimit(double share);
    /// Those of all robots, to be kept and, before one is connected, to be restored.
    const QJsonObject &limits() const { return limits_; }
    void setLimits(const QJsonObject &limits) { limits_ = limits; }
    /// The robot's largest speeds, in m/s and rad/s.
    const Twist2D &most() const { return most_; }
    /// The emergency stop of the robot: at once, without the control, latched until release().
    void stop();
    const StopControl &stopping() const { return stop_; }
    /// Ends driving softly; the control is given back.
    void yieldControl();
    /// The same, and what is held must be let go first. reason: why, for people.
    void halt(const QString &reason = {});
    /// Ends the emergency stop and latched faults. A stop that was not pressed here is ended by the second
    /// call only, within five seconds.
    void release();
    bool isReleaseAsked() const { return confirmation_.isAwaited(); }
    /// Takes the control from whoever holds it.
    void takeOver() { acquire(true); }

    /// While a replay is shown nobody sees where the robot is: it is driven only once this was said, until
    /// that replay ends.
    void driveBlindly();
    bool refusesForReplay() const { return sessions_.isReplaying() && !isBlindMeant_; }
    Sessions &sessions() { return sessions_; }

    /// Somebody who can be driven is there.
    bool isPossible() const { return motors() != nullptr; }
    bool isDriving() const { return isDriving_; }
    /// What is held does not count: let go first.
    bool mustLetGo() const { return inputs_.mustRest(); }
    /// Or STOP is on its way.
    bool isStopped() const { return !hold_.latched.isEmpty() || stop_.phase() != StopPhase::None; }
    /// Why the robot does not move, by cause: "estop", faults.
    const QMap<QString, QString> &latched() const { return hold_.latched; }
    /// The same for people; empty: nothing stops it.
    QString stopReason() const;
    /// It has confirmed that it stands, and its odometry does not say otherwise.
    bool isStanding() const;
    /// Who holds the control: "" nobody, "you", or the name of another client.
    QString holder() const;
    bool isHeldByOther() const;
    /// Who asks for the control that this program has; empty: nobody.
    QString wanted() const;
    /// The velocity that is commanded, by whoever drives, and the one that odometry measures.
    const Twist2D &commanded() const { return isDriving_ || !isPossible() ? commanded_ : target_; }
    const Twist2D &measured() const { return measured_; }
    /// How old that is, and what the motor control says of its state.
    const Freshness &measuredAge() const { return measuredAge_; }
    const Freshness &stateAge() const { return stateAge_; }
    /// The refusal of the last command, or what else hinders; empty while all is well.
    const QString &problem() const { return problem_; }

Q_SIGNALS:
    void changed();
    /// STOP was pressed.
    void stopPressed();

private:
    static constexpr double usualShare = 0.4;
    static constexpr Twist2D usualMost{0.5, 0.5, 1};

    static constexpr Twist2D scaled(const Twist2D &speeds, double share) {
        return {speeds.vx * share, speeds.vy * share, speeds.omega * share};
    }
    /// The smaller of each.
    static constexpr Twist2D least(const Twist2D &one, const Twist2D &other) {
        return {std::min(one.vx, other.vx), std::min(one.vy, other.vy), std::min(one.omega, other.omega)};
    }
    DaemonLink *motors() const;
    void follow();
    void onMoved(const DaemonLink *daemon, Robot *to);
    /// Why the robot may not be removed now; empty: it may.
    QString objection(const Robot &robot) const;
    void takeMost(const QJsonValue &motion);
    void putLimit(const Twist2D &limit);
    void tick();
    void turn();
    void end();
    void acquire(bool takeOver);
    void ask();
    void giveBack();
    void lose();
    void send();
    void poll();
    void onState(const QJsonValue &state);
    void onReplay();
    void onOdometry(const TopicUpdate &update);
    /// What all inputs request together, in m/s and rad/s.
    Twist2D request() const;
    void tell(const QString &problem);

    Fleet &fleet_;
    TopicFeed odometry_;
    QPointer<DaemonLink> motors_, driven_; ///< the second is away, as may be
    Subscription settings_;                ///< the topic
    StopControl stop_;
    StopPhase shownPhase_ = StopPhase::None;
    Sessions sessions_;
    QTimer timer_, pollTimer_;
    QTimer letGo_; ///< since nothing is held
    DriveInputs inputs_;
    SecondPress confirmation_;
    QElapsedTimer ticked_;   ///< the last turn of the timer
    QElapsedTimer lost_;     ///< since the control was given back
    QElapsedTimer answered_; ///< of this drive: the last answer to a command
    MotionHold hold_;
    Twist2D most_ = usualMost, commanded_, measured_;
    bool movesSideways_ = true;
    double leastRadius_ = 0; // of its bends, m; 0: it turns on the spot
    Twist2D target_;         ///< of the motor control
    int losses_ = 0;         ///< of the control
    Freshness measuredAge_, stateAge_;
    ClockOffset clock_;
    Twist2D limit_ = scaled(usualMost, usualShare);
    QJsonObject limits_; ///< vx, vy, omega of each robot, by the address of its motor control
    bool isDriving_ = false, isHolding_ = false, isAsking_ = false, isPolling_ = false;
    bool isBlindMeant_ = false;
    QString problem_, heldProblem_; ///< the second: it ends when nobody else has the control
};

} // namespace hermes::desktop
