#pragma once

#include "common/daemon/Daemon.h"
#include "common/recording/Recording.h"
#include "daemons/seriallogger/LoggedPort.h"
#include "daemons/seriallogger/SerialPlayer.h"
#include "daemons/seriallogger/SerialRecorder.h"

#include <QElapsedTimer>
#include <QThreadPool>
#include <atomic>

namespace hermes {

/// hermes-seriallogger: records the bytes of any number of ports as they come, with the time of each; shows
/// lines and GPS fixes of them, or of a recording.
class SerialLogger : public Daemon {
public:
    SerialLogger();

protected:
    Result<void> start() override;
    void stop() override;

private:
    /// Where lines and fixes come from.
    enum class Source { Live, Replay, Ended };

    void declareSettings();
    void declareTopics();
    void declareCommands();
    void declareSourceCommands();

    void addPort(const PortSettings &settings);
    LoggedPort *findPort(const QString &name) const;
    Error noSuchPort(const QString &name) const;

    Result<QJsonValue> mark(const Call &call);
    void send(const Call &call, const Reply &reply);
    void exportRecording(const Call &call, const Reply &reply);

    Result<QJsonValue> openSource(const Call &call);
    Result<void> openRecording(const Call &call);
    void endReplay();
    void openViews();
    void replayEnded(const Result<void> &result);
    Result<QJsonValue> pause(bool paused);
    SourceStatus sourceState() const;
    void updateSourceHealth();

    /// For other threads to tell that a view was filled.
    std::function<void()> viewFilled();
    PortView::Sinks sinks(const QString &port);
    void processViews();
    void tick();
    void updateHealth();
    void updateHealth(const LoggedPort &port);
    std::vector<PortStatus> portList() const;
    SerialMessage state() const;

    std::vector<std::unique_ptr<LoggedPort>> ports_; ///< outlive the recorder, which takes from them
    SerialRecorder recorder_;
    Recording recording_;
    SerialPlayer player_;
    Source source_ = Source::Live;
    QString sourceName_, sourceError_; ///< of a replay
    double speed_ = 1;
    quint64 generation_ = 0; ///< counts replays, so that the end of an old one is not taken for a new one's
    QTimer second_;
    QTimer viewTimer_;
    QTimer settleTimer_; ///< for fixes that nothing more comes for
    QElapsedTimer sinceTick_;
    QThreadPool exports_; ///< one after the other
    std::atomic<bool> cancelExports_{false};
};

} // namespace hermes
