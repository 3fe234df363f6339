#pragma once

#include "common/daemon/Command.h"
#include "common/daemon/PastFaults.h"
#include "common/recording/FileSync.h"
#include "common/recording/RecordingSession.h"
#include "common/settings/Settings.h"

#include <QElapsedTimer>
#include <QThreadPool>
#include <QTimer>
#include <vector>

namespace hermes {

/// What every logger shares: the commands record.*, their settings, which it declares, the session folder
/// with its sidecar, the guard of the disk, health items "recording" and "disk", and the completion of
/// recordings that were cut off. What was written is on the disk a second later at most. The logger adds
/// commands() to its own, calls open() and close() with its start and stop, and writes as a RecordingWriter.
/// Never waits for the disk in the main thread, but in close().
class Recording : public QObject {
    Q_OBJECT
public:
    /// How many files a recording has of each source: one, or a new one after a while.
    enum class Files { One, Several };
    /// logger: the daemon's name, and that of sidecar and files.
    Recording(const QString &logger, Settings &settings, Health &health, RecordingWriter &writer,
              Files files = Files::One);
    ~Recording() override;

    std::vector<Command> commands();

    /// Asked before one begins, whether it may.
    void setCondition(std::function<Result<void>()> condition) { condition_ = std::move(condition); }
    void open();
    void close();

    bool isActive() const { return phase_ != Phase::Idle; }
    /// Of the recording under way or the last.
    RecordingStatus status() const;

Q_SIGNALS:
    /// One began or ended.
    void changed();
    /// All that earlier processes recorded is complete. latest: the sidecar of what ended last, so long ago;
    /// empty: nothing was recorded.
    void completed(const QJsonObject &latest, double since_s);

private:
    enum class Phase { Idle, Starting, Recording, Ending };
    using Done = std::function<void()>;

    void declareSettings(Files files);
    void start(const Call &call, const Reply &reply);
    void stop(const Call &call, const Reply &reply);
    void list(const Reply &reply);
    void end(RecordingEnd reason, const std::optional<Error> &error);
    void ended(const Result<void> &result);
    void giveToStopping(const Result<QJsonValue> &result);
    void sync();
    void check();
    void checked(const Result<double> &room, const Result<void> &there, const Result<void> &refreshed);
    void updateHealth();
    void updateDiskHealth();
    RecordingSession::Options options() const;
    /// Runs the job in the thread of the pool, and what it gives in the main thread.
    void run(QThreadPool &pool, std::function<Done()> job);

    const QString logger_;
    Settings &settings_;
    Health &health_;
    RecordingWriter &writer_;
    RecordingSession session_; ///< of the thread while a job runs
    FileSync sync_;            ///< of the thread while a sync runs
    QThreadPool disk_, syncs_; ///< one thread each: jobs run one after another
    QTimer timer_;
    bool closed_ = true;
    bool checking_ = false, syncing_ = false;
    QElapsedTimer sinceSync_; ///< began
    int checks_ = 0;

    Phase phase_ = Phase::Idle;
    SessionName name_;  ///< of this recording or the last
    QString beginning_; ///< the session of the next
    QString folder_;
    Moment start_;
    double endMono_ = 0; ///< when it was told to end
    std::function<Result<void>()> condition_;
    RecordingEnd endReason_ = RecordingEnd::Stopped;
    std::optional<Error> error_; ///< that ended it
    std::optional<Error> refreshError_;
    PastFaults losses_;
    std::vector<Reply> stopping_; ///< who waits for the end
    bool isChecked_ = false;      ///< free_ was read, or could not be
    std::optional<double> free_;  ///< bytes
    QStringList cutOff_;          ///< recordings that this start has completed, until another begins
    QStringList unrepaired_;      ///< why recordings that were cut off could not be completed
};

} // namespace hermes
