#pragma once

#include "daemons/motorcontrol/MotorSettings.h"
#include "daemons/motorcontrol/ReadingRate.h"
#include "daemons/motorcontrol/RestartWatch.h"
#include "daemons/motorcontrol/StandstillWatch.h"
#include "protocol/drive/Bus.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace hermes::motorcontrol {

/// One motor controller. Decides what to ask, never sends: its line calls next() when it is free, and
/// finished() with the answer. What is said then is its device's business.
///
/// Whatever may turn its motors is stopped first: a controller that is new, was lost, or does not stand
/// though it was told to, is sent nothing but set-points of zero until it has acknowledged one and its
/// encoders show that it stands. Where it does not, its line is silent after each attempt for longer than the
/// controller's own time-out. Only then it is set up, and only then it gets other set-points.
///
/// A stop is sent again (stopAnswered() decides, next() gives it to the line):
///  the first one was not acknowledged                     at once, 0.03 s after it was sent
///  a later one was not, or the wheels turn all the same   after silence_s(): its own time-out and 0.1 s
///  it is barred                                           every 5 s
///
/// One that turned though it was told to stand, or whose encoders cannot be trusted, is barred: it is told to
/// stand every five seconds, and left in silence, until somebody releases it.
class MotorController {
public:
    /// In the order of precedence on the line.
    enum class Task { SetPoint, Encoders, Background };
    static constexpr int taskCount = 3;
    static constexpr double lostAfter_s = 0.25;  ///< without answers
    static constexpr double slowLostAfter_s = 3; ///< without one of the slow readings
    static constexpr double freshDuty_s = 0.3;
    static constexpr double leastRate_Hz = 10; ///< of set-points and readings: slower nothing is driven
    static constexpr double overspeed = 1.5;   ///< times full duty: faster no motor turns

    /// A request, and how long its answer is waited for (seconds). For one that is patient nothing else is
    /// driven.
    struct Ask {
        drive::Command command;
        drive::Request request;
        double timeout_s;
        bool isPatient() const { return timeout_s > longestDrivingReplyTimeout_s; }
    };

    /// onLine: controllers that share its line.
    MotorController(int number, const ControllerAddress &address, int onLine);

    /// Sets it up anew when PID or time-out differ.
    void configure(const MotorSettings &settings);
    void lineClosed(const QString &reason);
    /// Stops it, and keeps it so until release().
    void bar(const QString &reason);
    void release();
    /// While another one on the line is waited for, or the line is kept silent, it is not this one's fault
    /// that it is not heard.
    void setLineHeld(bool held) { lineHeld_ = held; }

    /// New speeds (counts/s) of M1 and M2, to be sent at once.
    void command(const std::array<qint32, 2> &speeds, std::optional<double> servo = {});
    /// The encoders shall be read, and one of the slow readings.
    void beginCycle(double now);
    /// It has to be told to stand before anything else is sent to anyone.
    bool isToStop() const;
    /// The request that is due for this task, if any.
    std::optional<Ask> next(Task task, double now);
    void finished(const drive::Bus::Outcome &outcome, double now);
    /// Nothing may be sent on its line before: it stops by its own time-out.
    double silentUntil() const { return silentUntil_; }

    /// Set up, and answers.
    bool isReady() const { return state_ == State::Ready; }
    /// Has acknowledged that it shall stand, its encoders say that it does, it has had the time to brake
    /// (encoders without supply say so at once), and it is heard.
    bool stands() const {
        const bool isHeard = isReady() || awake_ - answered_ <= lostAfter_s;
        return !barred_ && watch_.stands() && awake_ >= brakesUntil_ && isHeard;
    }
    /// It is not heard, and its last set-point may still turn its wheels.
    bool mayTurn() const { return !isReady() && awake_ < turnsUntil_; }
    /// Its line gives fewer set-points than leastRate_Hz.
    bool isTooSlow() const { return rate_.isBelow(); }
    /// How often its encoders are read; nothing until that is known.
    std::optional<double> rate_Hz() const { return rate_.perSecond(); }
    /// Its last requests were not answered as they should; one alone may be damaged on any line.
    bool isFailing() const { return failures_ > 1; }
    /// The last command was acknowledged, or, where it is not ready, that it shall stand was said.
    bool hasObeyed() const { return isReady() ? obeyed_ == commanded_ : isToldToStand(); }
    /// What it did though it was told to stand; empty when nothing. Asking forgets it.
    QString takeDisobedience() { return std::exchange(disobedience_, QString()); }
    /// "controller 1 (0x80 on serial:///dev/ttyS1)"
    const QString &name() const { return name_; }
    quint8 address() const { return quint8(place_.address); }
    const QString &url() const { return place_.url; }
    /// Why it is not ready.
    const QString &error() const { return error_; }
    const QString &version() const { return version_; }
    const drive::Readings &readings() const { return readings_; }
    /// The duties of its motors (-1 to 1), unless they were read more than freshDuty_s ago: older ones may be
    /// of another set-point.
    std::optional<std::array<double, 2>> freshDuty() const {
        return clock_ - lastDuty_ <= freshDuty_s ? readings_.duty : std::nullopt;
    }
    /// After which it stops by itself when it is told nothing, once it is set up.
    drive::DeviceTimeout timeout() const { return device_->timeout(); }
    /// Cycles whose encoders were not read in time.
    quint64 overruns() const { return overruns_; }

private:
    enum class State { Stopping, SetUp, Ready };
    enum class StopStep {
        Tell,       ///< to stand, at once
        SetTimeout, ///< silence stops only one that has a time-out
        CutPower,   ///< and wait for the answer in silence
        Look,       ///< whether its encoders say that it stands: it has acknowledged that it shall
    };
    static constexpr double shortestReplyTimeout_s = 0.03; ///< FTDI adapters hold bytes for up to 16 ms
    static constexpr double longestDrivingReplyTimeout_s = 0.06;
    static constexpr double timeoutMargin_s = 0.1; ///< of the controllers' own clock

    std::optional<Ask> due(Task task, double now) const;
    std::optional<Ask> dueStop(Task task, double now) const;
    std::optional<Ask> dueReady(Task task) const;
    void stopAnswered(const drive::Command &command, const drive::Bus::Outcome &outcome, double now);
    void setupAnswered(const drive::Command &command, const drive::Bus::Outcome &outcome, double now);
    void readyAnswered(const drive::Command &command, const drive::Bus::Outcome &outcome);
    /// Of the answers to the set-up; the program or the machine may have stood still in some of them.
    double usualReplyTime();
    void becomeReady();
    /// Its own time-out is no longer than the settings promise.
    bool keepsPromise() const;
    void takeCounts(const drive::Bus::Outcome &outcome);
    void nextSlow();
    /// A slow reading that is not vital was not answered.
    void missSlow();
    /// Seconds until it is seen to stand after it was told to.
    double brakingTime() const;
    /// From the set-point of now to standing, in seconds.
    double rampTime() const;
    bool isToldToStand() const { return stopStep_ != StopStep::Tell; }
    /// How it is told again to stand.
    StopStep nextAttempt() const {
        return timeoutKnown_ || device_->timeout().isFixed ? StopStep::CutPower : StopStep::SetTimeout;
    }
    void keepSilent(const drive::Bus::Outcome &outcome);
    void watchStandstill();
    void watchAnswers();
    void lose(const QString &reason);
    void failSetup(const QString &reason, double now);
    void refuseSetup(const QString &reason, double now);
    Ask ask(const drive::Command &command, double timeout_s) const;
    QString failureOf(const drive::Command &command) const;
    /// Longer than the controller's own time-out.
    double silence_s() const;

    ControllerAddress place_;
    QString name_;
    int onLine_;
    std::unique_ptr<drive::MotorDevice> device_;
    double fullSpeed_ = drive::VelocityPid().qpps; // counts/s
    double promised_s_ = 0;                        // until it stops by itself
    bool mayLackTimeout_ = false;
    StandstillWatch watch_;
    ReadingRate rate_{leastRate_Hz};
    quint32 deceleration_ = 1; // counts/s^2
    double disobeyAfter_s_ = 0.7;

    State state_ = State::Stopping;
    QString error_ = "has not answered yet";
    QString disobedience_, barReason_;
    bool lineHeld_ = false;
    double lastCycle_ = 0; // monotonic
    double clock_ = 0;     // seconds of cycles in which it could be asked
    double awake_ = 0;     // seconds of all cycles
    double answered_ = 0;  // the last request, by that

    // Stopping and set-up.
    StopStep stopStep_ = StopStep::Tell;
    bool isFirstStop_ = true;                               // since it was lost
    bool barred_ = false, timeoutKnown_ = false;            // its time-out was read back
    double setPointSent_ = 0;                               // monotonic
    double brakeUntil_ = 0;                                 // monotonic: so long its wheels may turn
    double timeoutAtMost_s_;                                // that it may have
    double silentUntil_ = 0, nextStop_ = 0, nextSetup_ = 0; // monotonic
    int setupStep_ = 0;
    std::vector<double> replyTimes_; // seconds
    QString version_;

    // What is asked, and since when nothing was heard; by clock_.
    std::optional<drive::Command> asked_;                   // while the answer is still wanted
    int failures_ = 0;                                      // in a row
    drive::Bus::Result failure_ = drive::Bus::Result::Done; // the last one
    bool heard_ = false;                                    // it has answered something since it was silent
    double lastAnswer_ = 0, lastObeyed_ = 0, lastCounts_ = 0, lastSlow_ = 0;
    double lastDuty_ = 0, nextDuty_ = 0; // while it is not known it is asked again then

    // Ready.
    double replyTimeout_s_ = 0;
    RestartWatch restarts_;
    bool wantsEncoders_ = false, wantsSlow_ = false;
    quint64 commanded_ = 0, sent_ = 0, obeyed_ = 0; // set-points, counted
    bool toldToTurn_ = false;                       // by the last one that was sent
    std::array<qint32, 2> speeds_{};
    std::optional<double> servo_; // 0 to 1
    /// Until then wheels that were told to turn can hardly stand, whatever their encoders say, or may turn by
    /// a set-point that nobody can take back (by awake_: they brake, and their time-out runs, in silence,
    /// too).
    double brakesUntil_ = 0, turnsUntil_ = 0;
    double standBy_ = 0; // by clock_: until then it must stand; while its set-point is zero
    int slow_ = 0;
    drive::Readings readings_;
    quint64 overruns_ = 0;
};

} // namespace hermes::motorcontrol
