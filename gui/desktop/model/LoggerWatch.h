#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/session/SessionMember.h"

#include <deque>

namespace hermes::desktop {

/// The loggers of the chosen robot, and what record.status says of each, asked once a second.
class LoggerWatch : public QObject {
    Q_OBJECT
public:
    explicit LoggerWatch(Fleet &fleet, QObject *parent = nullptr);

    /// To record and replay with.
    const SessionMembers &members() const { return members_; }
    /// By the name of the member; of those that have answered.
    const std::map<QString, QJsonObject> &states() const { return states_; }

    bool isRecording() const { return !recording().empty(); }
    /// One of those that record has marks.
    bool marks() const;
    QString name() const;
    double bytes() const;
    double seconds() const;
    /// Seconds until the fullest disk is full at the rate of the last ten seconds; negative: not known.
    double secondsLeft() const;

    /// The names of those that do not answer.
    QStringList silent() const;

    void poll();

Q_SIGNALS:
    void changed();
    /// Loggers came or went.
    void membersChanged();

private:
    void follow();
    std::vector<QJsonObject> recording() const;

    Fleet &fleet_;
    QTimer timer_;
    SessionMembers members_;
    std::map<QString, QJsonObject> states_;
    std::deque<std::pair<double, double>> progress_; // monotonic seconds, bytes
};

} // namespace hermes::desktop
