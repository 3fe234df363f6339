#include "daemons/recorder/SessionCommands.h"

#include <QJsonArray>
#include <map>

namespace hermes::recorder {
namespace {

/// What is in the way of a new recording of this name.
QStringList obstacles(const SessionMembers &members, const SessionReplies &states,
                      const SessionReplies &lists, const QString &name) {
    QStringList lines = members.silent + complaints(states);
    for (const SessionReply &state : states)
        if (const RecordingStatus status = state.status(); status.recording)
            lines.append(QString("%1 records \"%2\" already; session.stop ends it")
                             .arg(state.member.name, status.name.value_or(QString())));
    for (const SessionReply &list : lists)
        for (const QJsonValue &entry : list.result ? list.result->toArray() : QJsonArray())
            if (entry["name"].toString() == name)
                lines.append(QString("%1 has a recording \"%2\" already (%3)")
                                 .arg(list.member.name, name, entry["folder"].toString()));
    lines += complaints(lists);
    if (members.all.empty())
        lines.append("no logger is connected");
    return lines;
}

/// What does not agree between how a logger ended and its sidecar.
QStringList differences(const RecordedPart &part, const RecordingStatus &end) {
    QStringList lines;
    for (const auto &[what, isSame] : {std::pair("files", end.files == part.entry.files),
                                       {"bytes", end.bytes == part.entry.bytes},
                                       {"counts", end.counts == part.entry.counts},
                                       {"losses", end.losses == part.entry.losses}})
        if (!isSame)
            lines.append(QString("%1: its %2 at the end and in its sidecar are not the same")
                             .arg(part.member.name, QLatin1String(what)));
    return lines;
}

/// What is known of a session by how its loggers ended and the sidecars.
EndedSession endedSession(const QString &id, const SessionReplies &replies, const SessionList &list) {
    EndedSession ended{{}, complaints(replies)};
    std::map<QString, RecordingStatus> ends;
    for (const SessionReply &reply : replies)
        if (reply.result)
            ends[reply.member.name] = reply.status();
    for (const RecordedSession &session : list.sessions) {
        if (session.id != id)
            continue;
        ended.problems += session.problems();
        for (const RecordedPart &part : session.parts) {
            ended.parts.push_back(part);
            if (const auto end = ends.find(part.member.name); end != ends.end()) {
                ended.problems += differences(part, end->second);
                ends.erase(end);
            }
        }
    }
    for (const auto &[name, end] : ends)
        ended.problems.append(name + ": its sidecar cannot be read; " + list.problems.join("; "));
    return ended;
}

void takeBack(const QString &name, const QString &id, const SessionReplies &replies, QObject *context,
              const WhenDone<Result<SessionReplies>> &done) {
    std::vector<SessionCall> toStop;
    for (const SessionReply &reply : replies)
        if (reply.result || isUnconfirmed(reply.result))
            toStop.push_back(stopCall(reply.member, id));
    callAll(toStop, "record.stop", stopLimit, context, [=](const SessionReplies &ends) {
        QStringList lines = complaints(replies);
        for (const SessionReply &end : ends) {
            if (end.result)
                lines.append(QString("%1 had begun and was stopped, see %2")
                                 .arg(end.member.name, end.status().folder.value_or(QString())));
            else if (!end.result.error().is(ErrorCode::NotReady)) // it had not begun
                lines.append(QString("%1 may have begun and could not be stopped: %2")
                                 .arg(end.member.name, end.result.error().message));
        }
        done(sessionError(QString("\"%1\" is not recorded").arg(name), lines));
    });
}

} // namespace

void startSession(const SessionMembers &members, const QString &name, const QString &id, QObject *context,
                  const WhenDone<Result<SessionReplies>> &done) {
    const auto begun = [=](const SessionReplies &replies) {
        complaints(replies).isEmpty() ? done(replies) : takeBack(name, id, replies, context, done);
    };
    const auto asked = [=](const SessionReplies &states, const SessionReplies &lists) {
        const QStringList lines = obstacles(members, states, lists, name);
        if (!lines.isEmpty())
            return done(sessionError("nothing was begun", lines));
        callAll(callsOf(members.all, {{"name", name}, {"session", id}}), "record.start", members.timeout,
                context, begun);
    };
    callAll(callsOf(members.all), "record.status", members.timeout, context,
            [=](const SessionReplies &states) {
                callAll(callsOf(members.all), "record.list", members.timeout, context,
                        [=](const SessionReplies &lists) { asked(states, lists); });
            });
}

/// Those that record it, and what is told of those that an error has stopped.
void stopSession(const SessionMembers &members, const QString &id, QObject *context,
                 const WhenDone<Result<EndedSession>> &done) {
    const auto asked = [=](const SessionReplies &states) {
        const QStringList problems = members.silent + complaints(states);
        std::vector<SessionCall> active;
        bool isKnown = !problems.isEmpty();
        for (const SessionReply &state : states) {
            const RecordingStatus status = state.status();
            if (status.session != id)
                continue;
            isKnown = isKnown || status.error;
            if (status.recording)
                active.push_back(stopCall(state.member, id));
        }
        if (active.empty() && !isKnown)
            return done(Error(ErrorCode::NotReady, "nothing is being recorded"));
        callAll(active, "record.stop", stopLimit, context, [=](const SessionReplies &ends) {
            listSessions(members, context, [=](const SessionList &list) {
                EndedSession ended = endedSession(id, ends, list);
                ended.problems = problems + ended.problems;
                done(ended);
            });
        });
    };
    callAll(callsOf(members.all), "record.status", members.timeout, context, asked);
}

void listSessions(const SessionMembers &members, QObject *context, const WhenDone<SessionList> &done) {
    callAll(callsOf(members.all), "record.list", members.timeout, context,
            [done, silent = members.silent](const SessionReplies &replies) {
                SessionList list = SessionList::of(replies);
                list.problems = silent + list.problems;
                done(list);
            });
}

} // namespace hermes::recorder
