#pragma once

#include "common/client/Client.h"

#include <QJsonObject>
#include <QPointer>
#include <QStringList>
#include <vector>

namespace hermes {

/// A logger that takes part in sessions: a daemon that describes the command record.start.
struct SessionMember {
    QString name; ///< "seriallogger"; with "@HOST:PORT" where several have it
    QPointer<Client> client;
    bool marks = false;                    ///< it has the command mark
    bool replays = false;                  ///< and source.open
    bool seeks = false, setsSpeed = false; ///< source.seek and source.speed
    bool listsMarks = false;               ///< and record.marks
    bool endsOne = false;                  ///< its record.stop takes a session
};

/// All loggers of a robot.
struct SessionMembers {
    std::vector<SessionMember> all;
    QStringList silent; ///< a line for each daemon that may be one, but does not say what it is
    std::chrono::milliseconds timeout = Client::defaultTimeout; ///< of a reply

    /// Whether a daemon has a command, and, if a parameter is given, whether it takes that.
    using Has = std::function<bool(const QString &method, const QString &param)>;

    /// Adds a daemon by the commands that it has; false when it is no logger.
    bool add(const QString &name, Client &client, const Has &has);
};

struct SessionCall {
    SessionMember member;
    QJsonObject params;
};
struct SessionReply {
    SessionMember member;
    Result<QJsonValue> result;

    /// "seriallogger: what failed"; only where something did.
    QString complaint() const { return member.name + ": " + result.error().message; }
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

/// A source that shows what was recorded: at the end of a replay it still does.
bool isReplay(const QJsonValue &source);

/// A line for each that failed.
QStringList complaints(const SessionReplies &replies);

/// NotReady, with a line for each thing that is wrong.
Error sessionError(const QString &what, const QStringList &lines);

} // namespace hermes
