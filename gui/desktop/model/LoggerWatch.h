#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/session/SessionMember.h"

#include <deque>

namespace hermes::desktop {

/// Those of a robot that can be spoken to.
SessionMembers loggersOf(const Robot &robot);

/// The loggers of the chosen robot, and what record.status says of each, asked once a second. One that goes
/// while it records is remembered.
class LoggerWatch : public QObject {
    Q_OBJECT
public:
    explicit LoggerWatch(Fleet &fleet, QObject *parent = nullptr);

    /// To record and replay with.
    const SessionMembers &members() const { return members_; }
    /// By the name of the member; of those that have answered.
    const std::map<QString, QJsonObject> &states() const { return states_; }

    bool isRecording() const { return !recording().empty(); }
    bool marks() const { return !markers().all.empty(); }
    /// Of all recordings under way; as the loggers have them.
    QSet<QString> sessions() const;
    QString name() const;
    double bytes() const;
    double seconds() const;
    /// Seconds until the fullest disk is full at the rate of the last ten seconds; negative: not known.
    double secondsLeft() const;

    /// The names of those that do not answer.
    QStringList silent() const;
    /// A logger that was gone while it recorded.
    struct Lost {
        QString recording, session;
        bool isBack = false;
    };
    /// By the name of the logger, until forgetLost() or another robot.
    const std::map<QString, Lost> &lost() const { return lost_; }
    void forgetLost();
    /// So many marks are in the recording under way.
    int markCount() const;
    /// Those that record, and those of them that take marks.
    SessionMembers recordingMembers() const { return recordingMembers(false); }
    SessionMembers markers() const { return recordingMembers(true); }

    void poll();

Q_SIGNALS:
    void changed();
    /// Loggers came or went.
    void membersChanged();
    /// A logger records the session (an id) no more; name: of the recording.
    void ended(const QString &session, const QString &name);

private:
    void follow();
    void drop(const std::vector<SessionMember> &before);
    void take(const SessionReply &reply);
    void compare(const QString &logger, const QJsonObject &before, const QJsonObject &now);
    SessionMembers recordingMembers(bool onlyMarkers) const;
    std::vector<QJsonObject> recording() const;

    Fleet &fleet_;
    Robot *robot_ = nullptr; ///< that was chosen last; only to compare
    QTimer timer_;
    SessionMembers members_;
    std::map<QString, QJsonObject> states_;
    std::map<QString, double> heard_; ///< stamps (s): when each of them was told
    bool isHeard_ = false;            ///< one was, since the last question
    std::map<QString, Lost> lost_;
    QStringList silent_;
    std::deque<std::pair<double, double>> progress_; // monotonic seconds, bytes
};

} // namespace hermes::desktop
