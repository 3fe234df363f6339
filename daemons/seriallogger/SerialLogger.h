#pragma once

#include "common/daemon/Daemon.h"
#include "common/ports/SerialPlayer.h"
#include "common/ports/SerialRecorder.h"
#include "common/recording/Recording.h"
#include "common/recording/ReplaySource.h"
#include "daemons/seriallogger/LoggedPort.h"

#include <QElapsedTimer>
#include <QThreadPool>
#include <atomic>
#include <deque>

namespace hermes::seriallogger {

/// hermes-seriallogger: records the bytes of any number of ports as they come, with the time of each; shows
/// lines and GPS fixes of them, or of a recording.
class SerialLogger : public Daemon {
public:
    SerialLogger();

protected:
    Result<void> start() override;
    void stop() override;

private:
    void declareSettings();
    void declareTopics();
    void declareCommands();
    void declareSourceCommands();

    void addPort(const PortSettings &settings);
    LoggedPort *findPort(const QString &name) const;
    Error noSuchPort(const QString &name) const;

    Result<MarkAnswer> mark(const Call &call);
    void send(const Call &call, const Reply &reply);
    void exportRecording(const Call &call, const Reply &reply);
    void listMarks(const Call &call, const Reply &reply);

    ReplaySource::Actions sourceActions();
    void openLive();
    Result<void> openRecording(const Call &call, const StoredRecording &stored);
    /// That of a view in replayed_, which it makes; null: nothing is shown of the port.
    ChunkQueue *replayedQueue(const QString &port, const QJsonObject &sidecar);
    void replayEnded(const Result<void> &result);
    void updateSourceHealth();

    /// For other threads to tell that a view was filled.
    std::function<void()> viewFilled();
    PortView::Sinks sinks(const QString &port, bool isReplayed);
    void processViews();
    void tick();
    void updateHealth();
    void updateHealth(LoggedPort &port);
    std::vector<PortStatus> portList() const;
    SerialMessage state() const;

    std::vector<std::unique_ptr<LoggedPort>> ports_; ///< outlive the recorder, which takes from them
    SerialRecorder recorder_;
    Recording recording_;
    std::deque<std::pair<QString, PortView>> replayed_; ///< ports of the replay; outlive the player
    SerialPlayer player_;
    ReplaySource source_{"lines", identity().name, settings(), player_.playback(), sourceActions()};
    QTimer second_;
    QTimer viewTimer_;
    QTimer settleTimer_; ///< for fixes that nothing more comes for
    QElapsedTimer sinceTick_;
    QThreadPool exports_; ///< one after the other
    QThreadPool reads_;   ///< of marks, which wait for no export
    std::atomic<bool> cancelExports_{false};
};

} // namespace hermes::seriallogger
