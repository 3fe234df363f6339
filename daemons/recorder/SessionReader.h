#pragma once

#include "daemons/recorder/SessionList.h"
#include "protocol/mcap/Reader.h"
#include "protocol/wire/WireValue.h"

#include <QStringList>
#include <atomic>
#include <functional>

namespace hermes::recorder {

/// A message of a session, in the recorder's files.
struct SessionMessage {
    QString topic;    ///< "motorcontrol/odometry"
    double t_s = 0;   ///< after the beginning of the session, by a clock that never jumps
    double stamp = 0; ///< of its data: s since the epoch
    mcap::Message raw;
    const mcap::Channel &channel;
    const mcap::Schema *schema = nullptr; ///< nothing: none

    /// "motorcontrol"
    QString daemon() const { return topic.section('/', 0, 0); }
    /// "odometry"
    QString name() const { return topic.section('/', 1); }
    /// Undefined where it is no JSON.
    WireValue data() const;
};

/// Topics of this name; * stands for any text.
QString topicPattern(const QString &text);

/// Reads a session from its folder: sidecars and what the recorder wrote. Waits for the disk.
class SessionReader {
public:
    using Wanted = std::function<bool(const QString &topic)>;
    using Take = std::function<void(const SessionMessage &)>;

    /// InputOutput: there is no sidecar in the folder.
    /// stop: where it is true, what is read ends early.
    static Result<SessionReader> open(const QString &folder, const std::atomic<bool> *stop = nullptr);

    /// Gives the messages of these topics, of this time after the beginning, in the order in which they came.
    void read(const Wanted &wanted, const Take &take, double from_s = 0, double to_s = 1e9);

    const QString &folder() const { return folder_; }
    /// Of the recorder's files.
    double bytes() const;
    /// Its beginning, s since the epoch.
    double start() const { return start_; }
    /// As its sidecars tell it.
    const RecordedSession &recorded() const { return session_; }
    /// Messages that the recorder lost, by topic.
    const NamedCounts &lost() const { return lost_; }
    /// What could not be read so far, a line each.
    const QStringList &problems() const { return problems_; }
    /// One more of them.
    void note(const QString &problem);
    /// Not all was read: it was to end early.
    bool isStopped() const { return stop_ && *stop_; }

private:
    QString folder_;
    const std::atomic<bool> *stop_ = nullptr;
    QStringList files_; ///< of the recorder, in order
    double start_ = 0;
    RecordedSession session_;
    NamedCounts lost_; ///< by topic
    QStringList problems_;
};

} // namespace hermes::recorder
