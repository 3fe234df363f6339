#pragma once

#include "daemons/recorder/SessionReader.h"
#include "protocol/messages/Motion.h"

#include <QMap>
#include <vector>

namespace hermes::recorder {

/// The robot stopped to follow commands, or was given a reason to, as it stood.
struct Halt {
    double t_s = 0;        ///< after the beginning of the session
    QString cause, reason; ///< of MotionHold
    QString driver;        ///< who drove until then; empty: nobody
    double driven_from_s = 0, way_m = 0, fastest_mps = 0;
    double speed_mps = 0; ///< as it began to stop; a turn counts as one of 1 m
    QStringList later;    ///< further reasons until somebody drove again
};

/// What happened, for people.
struct Event {
    double t_s = 0;
    QString text;
};

/// What the topics of a session tell of who drove, why the robot stopped, who commanded what, and what was
/// wrong.
class DriveHistory {
public:
    /// keepsEvents: also what events() and wrongAt() tell, which takes memory.
    explicit DriveHistory(bool keepsEvents = true)
        : keepsEvents_(keepsEvents) {}

    /// The topics that are looked at.
    static bool wants(const QString &topic);
    void take(const SessionMessage &message);

    double duration_s() const { return last_s_; }
    /// The way, by odometry; nothing: there is none.
    const std::optional<double> &driven_m() const { return driven_m_; }
    /// As in SessionInfo.
    const QStringList &stops() const { return stops_; }
    const QStringList &faults() const { return faults_; }
    const std::vector<SessionMark> &marks() const { return marks_; }
    const std::vector<Halt> &halts() const { return halts_; }
    const std::vector<Event> &events() const { return events_; }
    /// Who drives at the end; empty: nobody.
    const QString &driver() const { return driver_; }
    /// The last halt that was no driver's wish; null: none.
    const Halt *lastFault() const;
    /// The nearest halt within 10 s; null: none.
    const Halt *haltNear(double t_s) const;
    /// A line for each health item that was not well then.
    QStringList wrongAt(double t_s) const;

private:
    struct Level {
        double t_s = 0;
        QString level, message;
    };

    void takeControl(double t_s, const WireValue &data);
    void halt(double t_s, const QString &cause, const QString &reason);
    void takeOdometry(const WireValue &data);
    void takeCommand(double t_s, const QString &daemon, const WireValue &data);
    void takeStatus(double t_s, const QString &daemon, const WireValue &data);
    void takeLog(double t_s, const QString &daemon, const WireValue &data);
    void add(double t_s, const QString &text);

    bool keepsEvents_;
    double last_s_ = 0;
    std::optional<double> driven_m_;
    QStringList stops_, faults_;
    std::vector<SessionMark> marks_;
    std::vector<Halt> halts_;
    std::vector<Event> events_;
    QMap<QString, std::vector<Level>> health_; ///< by daemon and item
    QString driver_, reason_, cause_;
    Halt drive_; ///< that goes on
    std::optional<Pose2D> at_;
    double speed_mps_ = 0;
    bool isControlKnown_ = false;
};

} // namespace hermes::recorder
