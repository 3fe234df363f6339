#pragma once

#include "common/daemon/Command.h"
#include "common/recording/Playback.h"
#include "common/recording/StoredRecording.h"
#include "common/settings/Settings.h"
#include "protocol/messages/Recordings.h"

#include <QElapsedTimer>
#include <QObject>

namespace hermes {

/// Where what a logger shows comes from: live, or a replay. The states, the commands source.* and what is
/// told of them are the same of all loggers.
class ReplaySource : public QObject {
public:
    enum class State { None, Live, Replay, Ended };
    using Ended = std::function<void(const Result<void> &)>;
    /// What a logger does to show another source. Each closes the one before, and calls opened().
    struct Actions {
        std::function<Result<void>(const Call &)> live;
        std::function<Result<void>(const Call &, const StoredRecording &)> recording;
        std::function<Result<void>(const Call &)> pcap;    ///< none: files are not played
        std::function<std::optional<double>()> duration_s; ///< of a replay; nothing: not known as yet
        std::function<bool()> records; ///< the source is being recorded now; none: it never is
        std::function<void()> changed;
    };

    /// what it shows, e.g. "packets"; the name of the logger and its settings lead to its recordings.
    ReplaySource(const QString &what, const QString &logger, const Settings &settings, Playback &playback,
                 Actions actions);

    State state() const { return state_; }
    bool isOpen() const { return state_ == State::Live || state_ == State::Replay; }
    /// A path, or where live data come from.
    const QString &name() const { return name_; }
    /// What ended the replay before its time.
    const QString &error() const { return error_; }
    SourceStatus status() const;

    /// Not while it is being recorded.
    Result<void> mayChange() const;
    /// None, until opened(). What the one before tells of its end counts for nothing.
    void close();
    void opened(State state, const QString &name);
    /// For the playing thread, to tell its end: then done is called in the main thread.
    Ended whenEnded(const Ended &done);
    /// A client has gone: what it replayed only as long as it is there ends.
    void clientGone(quint64 client);
    /// Whether what came may be shown now: a replay without loss waits for readers who are behind, but not
    /// for one that reads no more. hasRoom: every reader has some.
    bool mayShow(bool hasRoom);
    /// All that was played is shown; or why it ended before.
    void end(const Result<void> &result);

    /// source.open {live, recording, speed, paused, delay_s}; a logger adds what else it takes.
    Command openCommand(const QString &summary);
    /// source.seek, source.speed and source.pause.
    std::vector<Command> replayCommands();

private:
    Result<SourceStatus> open(const Call &call);
    Result<void> openRecording(const Call &call);
    Command whileReplaying(Command command, const std::function<void(const Call &)> &action);

    const QString what_, logger_;
    const Settings &settings_;
    Playback &playback_;
    const Actions actions_;
    State state_ = State::None;
    QString name_, error_;
    quint64 client_ = 0;      ///< with whom the replay ends; 0: with none
    quint64 generation_ = 0;  ///< counts sources
    QElapsedTimer sinceRoom_; ///< every reader had room
};

} // namespace hermes
