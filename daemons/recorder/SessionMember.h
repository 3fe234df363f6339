#pragma once

#include "common/daemon/RobotDaemons.h"
#include "protocol/messages/Recordings.h"

#include <QJsonObject>
#include <QStringList>
#include <vector>

namespace hermes::recorder {

/// A logger that takes part in sessions: a daemon that has the command record.start.
struct SessionMember {
    using Send = std::function<void(const QString &method, const QJsonObject &params,
                                    const Client::Callback &done, std::chrono::milliseconds timeout)>;

    QString name;         ///< "seriallogger"; with "@HOST:PORT" where several have it
    Send send;            ///< Calls one of its commands. The callback is dropped when the connection is gone.
    bool marks = false;   ///< it has the command mark
    bool replays = false; ///< and source.open
    bool seeks = false, setsSpeed = false; ///< source.seek and source.speed
    bool endsWithUs = false;               ///< its replay may end when this client goes
    bool endsOne = false;                  ///< its record.stop takes a session
};

/// All loggers of a robot.
struct SessionMembers {
    std::vector<SessionMember> all;
    QStringList silent; ///< a line for each daemon that may be one, but does not say what it is
    std::chrono::milliseconds timeout = Client::defaultTimeout; ///< of a reply
};

/// What the log says after the name of a daemon whose connection has ended: reports know by it.
constexpr const char *goneText = " has ended, or does not answer any more";

bool isLogger(const RobotDaemons::Daemon &daemon);
/// For a logger.
SessionMember memberOf(const RobotDaemons::Daemon &logger);
/// The loggers of a robot that are known; and who has been connected for a while and does not say what it is.
SessionMembers loggersOf(const RobotDaemons &daemons);

struct SessionCall {
    SessionMember member;
    QJsonObject params;
};
struct SessionReply {
    SessionMember member;
    Result<QJsonValue> result;

    /// "seriallogger: what failed"; only where something did.
    QString complaint() const { return member.name + ": " + result.error().message; }
    /// What a command record.* told; of a reply in another form the least that counts; as if nothing was
    /// recorded where it failed.
    RecordingStatus status() const;
};
using SessionReplies = std::vector<SessionReply>;

/// Nobody knows whether it was done: the reply did not come in time, or the connection ended before.
bool isUnconfirmed(const Result<QJsonValue> &reply);

/// Calls a method of several at the same time. done gets their replies in the order of the calls, once, from
/// the event loop; not when the context is gone by then.
void callAll(const std::vector<SessionCall> &calls, const QString &method, std::chrono::milliseconds timeout,
             QObject *context, const std::function<void(const SessionReplies &)> &done);

/// The same parameters for each.
std::vector<SessionCall> callsOf(const std::vector<SessionMember> &members, const QJsonObject &params = {});

/// For record.stop: ends no other session, where the logger can tell them apart.
SessionCall stopCall(const SessionMember &member, const QString &session);

/// A line for each that failed.
QStringList complaints(const SessionReplies &replies);

/// NotReady, with a line for each thing that is wrong.
Error sessionError(const QString &what, const QStringList &lines);

} // namespace hermes::recorder
