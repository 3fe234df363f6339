#pragma once

#include "daemons/motorcontrol/MotorSettings.h"
#include "protocol/roboclaw/Bus.h"

#include <optional>

namespace hermes {

/// What a controller has told last.
struct ControllerReadings {
    std::array<quint32, 2> counts{}; ///< of the encoders of M1 and M2, modulo 2^32
    double countsTime = 0;           ///< monotonic; 0: none since it was set up
    double battery_v = 0, logic_v = 0;
    std::array<double, 2> current_a{};
    double temperature_c = 0;
    quint32 status = 0;    ///< bits of roboclaw::StatusBit
    bool complete = false; ///< each of the slow ones has been read since it was set up
    int setups = 0;        ///< times it was set up: it may have been without power in between
};

/// One RoboClaw: set up with time-out and PID, which are read back; then set-points out and readings in.
/// Decides what to ask, never sends: its line calls next() when it is free, and finished() with the answer.
/// A controller that falls silent is set up again when it answers.
class MotorController {
public:
    /// In the order of precedence on the line.
    enum class Task { SetPoint, Encoders, Background };
    static constexpr int taskCount = 3;
    static constexpr double lostAfter_s = 0.25; ///< without answers

    MotorController(int number, const ControllerAddress &address);

    /// Sets it up anew when PID or time-out differ.
    void configure(const MotorSettings &settings);
    void lineClosed(const QString &reason);

    /// New speeds (counts/s) of M1 and M2, to be sent at once with this acceleration (counts/s^2).
    void command(const std::array<qint32, 2> &speeds, quint32 acceleration);
    /// The encoders shall be read, and one of the slow readings.
    void beginCycle(double now);
    /// The request that is due for this task, if any.
    std::optional<roboclaw::Request> next(Task task, double now);
    void finished(Task task, const roboclaw::Bus::Outcome &outcome, double now);

    /// Set up, and answers.
    bool isReady() const { return step_ == setupSteps; }
    /// Its last requests were not answered as they should; one alone may be damaged on any line.
    bool isFailing() const { return failures_ > 1; }
    /// The last command was acknowledged.
    bool hasObeyed() const { return isReady() && obeyed_ == commanded_; }
    /// "controller 1 (0x80 on serial:///dev/ttyS1)"
    const QString &name() const { return name_; }
    quint8 address() const { return quint8(place_.address); }
    const QString &url() const { return place_.url; }
    /// Why it is not ready.
    const QString &error() const { return error_; }
    const QString &version() const { return version_; }
    const ControllerReadings &readings() const { return readings_; }
    /// Cycles whose encoders were not read in time.
    quint64 overruns() const { return overruns_; }

private:
    // Version, then time-out and the PID of both motors, each written and read back.
    static constexpr int setupSteps = 7;
    static constexpr int slowReadings = 5;

    std::optional<roboclaw::Request> due(Task task, double now) const;
    roboclaw::Request setupRequest() const;
    /// Empty when the answer to the current step is as expected.
    QString setupFault(const roboclaw::Reply &reply) const;
    roboclaw::Request slowRequest() const;
    void takeSlow(const roboclaw::Bus::Outcome &outcome);
    void takeSetup(const roboclaw::Bus::Outcome &outcome, double now);
    void lose(const QString &reason);
    roboclaw::Request request(roboclaw::Command command, const roboclaw::Values &values = {}) const;

    ControllerAddress place_;
    QString name_;
    VelocityPid pid_;
    int timeoutTenths_ = 2;

    int step_ = 0; // of the set-up
    double nextAttempt_ = 0;
    QString error_ = "has not answered yet";
    QString version_;

    int failures_ = 0;    // in a row
    bool awaits_ = false; // the answer to a request that is still wanted
    bool wantsEncoders_ = false, wantsSlow_ = false;
    quint64 commanded_ = 0, sent_ = 0, obeyed_ = 0; // set-points, counted
    std::array<qint32, 2> speeds_{};
    quint32 acceleration_ = 1;
    int slow_ = 0;
    ControllerReadings readings_;
    double lastCycle_ = 0;                     // monotonic
    double sinceObeyed_ = 0, sinceCounts_ = 0; // seconds of cycles
    quint64 overruns_ = 0;
};

} // namespace hermes
