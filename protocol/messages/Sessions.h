#pragma once

#include "protocol/messages/Recordings.h"

#include <QString>
#include <QStringList>
#include <optional>
#include <vector>

namespace hermes {

/// What one daemon records, or recorded, of a session.
struct SessionPart {
    QString daemon; ///< its name; with "@HOST:PORT" where several daemons have it
    QString state; ///< recording, stopped, shut down, cut off, failed, free space, silent: it does not answer
    double bytes = 0;
    NamedCounts counts, losses;
    QString problem; ///< why something is missing, for people; empty: nothing is
};

/// A text that somebody put into a session.
struct SessionMark {
    double t_s = 0; ///< after the beginning of the session
    QString text;
};

/// A session that is replayed.
struct SessionReplay {
    double position_s = 0, duration_s = 0; ///< of the session; a duration of 0 is not known yet
    double speed = 1;
    bool paused = false, loop = false;
};

/// The topic `session`, and what session.start, session.stop, session.state and the commands of a replay
/// give: what the recorder does now, or what it did last.
struct SessionState {
    QString state;                    ///< idle, starting, recording, stopping, replaying
    QString name, session;            ///< of what is recorded or replayed, or was last; empty: nothing yet
    double start = 0;                 ///< s since the epoch
    double duration_s = 0;            ///< recorded so far, by a clock that never jumps
    double bytes = 0;                 ///< of all parts
    std::optional<double> free_bytes; ///< of the fullest disk
    std::optional<double> left_s;     ///< until that disk is full, at the rate of the last ten seconds
    std::vector<SessionPart> parts;   ///< while it is recorded, and after its end until the next begins
    std::vector<SessionMark> marks;   ///< in the order of their times
    QStringList problems;             ///< what is wrong with it, a line each, for people
    QStringList notes;                ///< what was not well with those that record it, as it began
    QStringList silent;               ///< daemons of the robot that do not answer
    std::optional<SessionReplay> replay;
};

/// Of what session.list gives a list, the latest first.
struct SessionSummary {
    QString name, session;
    double start = 0;                      ///< s since the epoch
    std::optional<double> end;             ///< the same; nothing: it goes on
    double bytes = 0;                      ///< of all parts
    QStringList daemons;                   ///< that have a part of it
    QStringList problems;                  ///< "velodynelogger: cut off"
    std::optional<double> duration_s = {}; ///< by a clock that never jumps; nothing: it goes on
};

/// A topic of a session, in its MCAP files.
struct SessionTopic {
    QString topic; ///< "motorcontrol/odometry"
    quint64 messages = 0, lost = 0;
    double rate_hz = 0;       ///< mean
    double longest_gap_s = 0; ///< between two messages
};

/// What session.info gives.
struct SessionInfo {
    SessionSummary summary;
    double duration_s = 0;
    std::optional<double> driven_m; ///< the way, by odometry
    std::vector<SessionPart> parts;
    std::vector<SessionTopic> topics;
    std::vector<SessionMark> marks;
    QStringList stops,
        faults; ///< "12.34 s: motor.estop by 127.0.0.1:5000", "13.00 s: motorcontrol roboclaw error: ..."
};

/// What session.explain gives.
struct SessionText {
    QString text; ///< a page for people
};

/// What session.export gives.
struct SessionFiles {
    QStringList paths;
    QStringList problems; ///< what of the session is missing in them, a line each, for people
};

Fields<SessionText> fieldsOf(Of<SessionText>);
Fields<SessionFiles> fieldsOf(Of<SessionFiles>);
Fields<SessionPart> fieldsOf(Of<SessionPart>);
Fields<SessionMark> fieldsOf(Of<SessionMark>);
Fields<SessionReplay> fieldsOf(Of<SessionReplay>);
Fields<SessionState> fieldsOf(Of<SessionState>);
Fields<SessionSummary> fieldsOf(Of<SessionSummary>);
Fields<SessionTopic> fieldsOf(Of<SessionTopic>);
Fields<SessionInfo> fieldsOf(Of<SessionInfo>);

} // namespace hermes
