#pragma once

#include "daemons/recorder/SessionList.h"

#include <QSet>

namespace hermes::recorder {

/// Records with all loggers of a robot as one session. What it does ends from the event loop, by the function
/// given with it, whatever the loggers do; nothing waits. One at a time.
class SessionRecorder : public QObject {
    Q_OBJECT
public:
    template <typename T>
    using Done = std::function<void(const T &)>;
    /// What record.status tells.
    struct States {
        SessionReplies replies;
        QStringList problems; ///< who does not tell, and why
    };
    /// How a session ended.
    struct Stopped {
        std::vector<RecordedSession> sessions; ///< that were ended, as the sidecars have them
        QStringList problems; ///< what is missing, or does not agree; empty when all is there
    };

    explicit SessionRecorder(const SessionMembers &members = {}, QObject *parent = nullptr)
        : QObject(parent)
        , members_(members) {}
    void setMembers(const SessionMembers &members) { members_ = members; }

    /// All begin one session, or none does: those that have begun, or may have, are stopped, and the error
    /// tells so. Gives the replies to record.start.
    void start(const QString &name, const Done<Result<SessionReplies>> &done);
    /// The id of the last session that start() had to stop; empty: none.
    const QString &takenBack() const { return takenBack_; }
    /// Ends a session, and compares what each told at its end with its sidecar. NotReady when nobody records
    /// it, and it has not ended by an error.
    void stop(const QString &session, const Done<Result<Stopped>> &done);
    /// Of a logger the reply to record.stop is waited for so long: everything is to get to the disk.
    static constexpr std::chrono::minutes stopLimit{2};
    /// Sessions that have ended, as the sidecars have them, and what does not agree with the replies to
    /// record.stop.
    void check(const QSet<QString> &ids, const SessionReplies &ends, const Done<Stopped> &done);
    void status(const Done<States> &done);
    void list(const Done<SessionList> &done);

private:
    void begin(const SessionMembers &members, const QString &name, const Done<Result<SessionReplies>> &done);
    void takeBack(const QString &name, const SessionReplies &replies,
                  const Done<Result<SessionReplies>> &done);
    void end(const QString &session, const States &states, const Done<Result<Stopped>> &done);

    SessionMembers members_;
    QString takenBack_;
};

} // namespace hermes::recorder
