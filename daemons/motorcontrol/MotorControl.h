#pragma once

#include "common/daemon/Daemon.h"
#include "common/daemon/PastFaults.h"
#include "daemons/motorcontrol/DriveLoop.h"
#include "daemons/motorcontrol/LatchFile.h"
#include "daemons/motorcontrol/MotorMessages.h"

#include <QThread>
#include <deque>

namespace hermes::motorcontrol {

/// The daemon hermes-motorcontrol: drives the wheels through their controllers. Receives and answers
/// in the main thread; a DriveLoop in its own thread does the rest.
class MotorControl : public Daemon {
    Q_OBJECT
public:
    MotorControl();
    ~MotorControl() override;

protected:
    Result<void> start() override;
    void stop() override;
    void settingsChanged(const QStringList &paths) override;

private:
    using Work = decltype(DriveMail::Job::work);

    void declareTopics();
    void declareMotorCommands();
    void declareControlCommands();
    /// A stop: answers what is confirmed to stand, at once or when all is, after wait_s at the latest.
    hermes::Command stopCommand(const QString &name, const QString &summary,
                                const std::function<void(const Call &, Drive &)> &stop);
    void answerStops();

    void afterGap(const QString &text);
    /// Runs in the loop's thread, sends what follows from it at once, and gives the reply.
    void inLoop(const Work &work, const Reply &reply);
    /// A command that acts upon the loop.
    hermes::Command loopCommand(const QString &name, const QString &summary,
                                const std::function<Result<QJsonValue>(const Call &, DriveLoop &)> &work);

    /// The same for one that was received after the last gap.
    hermes::Command
    freshLoopCommand(const QString &name, const QString &summary,
                     const std::function<Result<QJsonValue>(const Call &, DriveLoop &)> &work);

    void postJobs();
    void takeReports();
    void answerJobs(std::size_t count);
    void show(const Telemetry &telemetry);
    /// The emergency stop of before the start.
    void restoreStop();
    void keepStop();
    void updateHealth();
    QString runOnOf(std::size_t controller) const;
    void tellControllers();
    void tellMeasures();
    void tellCycle();
    void tellSlowWheels();
    void tellStop();
    bool isReady() const;
    MotorState state() const;

    DriveMail mail_;
    std::deque<DriveMail::Job> jobs_; // not yet answered
    std::size_t posted_ = 0;          // of them: the first ones
    QThread thread_;
    DriveLoop *loop_ = nullptr; // lives in thread_
    MotorSettings active_;      // what the loop works with
    Telemetry told_;
    LatchFile latchFile_;
    QString unkept_;     ///< why the emergency stop is not in the file
    QString loggedHalt_; ///< the last that is in the log
    struct WaitingStop {
        Reply reply;
        double until; // monotonic
    };
    std::vector<WaitingStop> stops_;
    std::array<PastFaults, controllerCount> answers_;
    BatteryGauge gauge_;
    bool runsOut_ = false; ///< the battery
    quint64 cycles_ = 0;
};

} // namespace hermes::motorcontrol
