#include "daemons/recorder/SessionRecorder.h"

#include <QJsonArray>
#include <QUuid>
#include <algorithm>
#include <map>

namespace hermes::recorder {
namespace {

bool isRecording(const SessionReply &state) {
    return state.result && (*state.result)["recording"].toBool();
}

/// What is in the way of a new recording of this name.
QStringList obstacles(const SessionRecorder::States &states, const SessionReplies &lists,
                      const QString &name) {
    QStringList lines = states.problems;
    for (const SessionReply &state : states.replies)
        if (isRecording(state))
            lines.append(QString("%1 records \"%2\" already; session.stop ends it")
                             .arg(state.member.name, (*state.result)["name"].toString()));
    for (const SessionReply &list : lists)
        for (const QJsonValue &entry : list.result ? list.result->toArray() : QJsonArray())
            if (entry["name"].toString() == name)
                lines.append(QString("%1 has a recording \"%2\" already (%3)")
                                 .arg(list.member.name, name, entry["folder"].toString()));
    return lines + complaints(lists);
}

/// What does not agree between how a logger ended and its sidecar.
QStringList differences(const RecordedPart &part, const QJsonValue &end) {
    QStringList lines;
    for (const char *member : {"files", "bytes", "counts", "losses"})
        if (end[QLatin1String(member)] != part.entry[QLatin1String(member)])
            lines.append(QString("%1: its %2 at the end and in its sidecar are not the same")
                             .arg(part.member.name, QLatin1String(member)));
    return lines;
}

/// Completes what is known of sessions with these ids by how their loggers ended and the sidecars.
void complete(SessionRecorder::Stopped &stopped, const QSet<QString> &ids, const SessionReplies &replies,
              const SessionList &list) {
    stopped.problems += complaints(replies);
    std::map<QString, QJsonValue> ends;
    for (const SessionReply &reply : replies)
        if (reply.result)
            ends[reply.member.name] = *reply.result;
    for (const RecordedSession &session : list.sessions) {
        if (!ids.contains(session.id))
            continue;
        stopped.sessions.push_back(session);
        for (const RecordedPart &part : session.parts) {
            if (const QString fault = part.fault(); !fault.isEmpty())
                stopped.problems.append(part.member.name + ": " + fault);
            if (const auto end = ends.find(part.member.name); end != ends.end()) {
                stopped.problems += differences(part, end->second);
                ends.erase(end);
            }
        }
        stopped.problems += session.absent();
    }
    for (const auto &[name, end] : ends)
        stopped.problems.append(name + ": its sidecar cannot be read; " + list.problems.join("; "));
}

} // namespace

void SessionRecorder::status(const Done<States> &done) {
    callAll(callsOf(members_.all), "record.status", members_.timeout, this,
            [done, silent = members_.silent](const SessionReplies &replies) {
                done(States{replies, silent + complaints(replies)});
            });
}

void SessionRecorder::list(const Done<SessionList> &done) {
    callAll(callsOf(members_.all), "record.list", members_.timeout, this,
            [=, silent = members_.silent](const SessionReplies &replies) {
                SessionList found = SessionList::of(replies);
                found.problems = silent + found.problems;
                done(found);
            });
}

void SessionRecorder::start(const QString &name, const Done<Result<SessionReplies>> &done) {
    status([=, members = members_](const States &states) { // all steps are with the same loggers
        const auto listed = [=](const SessionReplies &lists) {
            QStringList lines = obstacles(states, lists, name);
            if (members.all.empty())
                lines.append("no logger is connected");
            if (!lines.isEmpty())
                return done(sessionError("nothing was begun", lines));
            begin(members, name, done);
        };
        callAll(callsOf(members.all), "record.list", members.timeout, this, listed);
    });
}

void SessionRecorder::begin(const SessionMembers &members, const QString &name,
                            const Done<Result<SessionReplies>> &done) {
    const QJsonObject params{{"name", name}, {"session", QUuid::createUuid().toString(QUuid::WithoutBraces)}};
    callAll(callsOf(members.all, params), "record.start", members.timeout, this,
            [=](const SessionReplies &replies) {
                if (complaints(replies).isEmpty())
                    return done(replies);
                takenBack_ = params["session"].toString();
                takeBack(name, replies, done);
            });
}

void SessionRecorder::takeBack(const QString &name, const SessionReplies &replies,
                               const Done<Result<SessionReplies>> &done) {
    std::vector<SessionCall> toStop;
    for (const SessionReply &reply : replies)
        if (reply.result || isUnconfirmed(reply.result))
            toStop.push_back(stopCall(reply.member, takenBack_));
    callAll(toStop, "record.stop", stopLimit, this, [=](const SessionReplies &ends) {
        QStringList lines = complaints(replies);
        for (const SessionReply &end : ends) {
            if (end.result)
                lines.append(QString("%1 had begun and was stopped, see %2")
                                 .arg(end.member.name, (*end.result)["folder"].toString()));
            else if (!end.result.error().is(ErrorCode::NotReady)) // it had not begun
                lines.append(QString("%1 may have begun and could not be stopped: %2")
                                 .arg(end.member.name, end.result.error().message));
        }
        done(sessionError(QString("\"%1\" is not recorded").arg(name), lines));
    });
}

void SessionRecorder::stop(const QString &session, const Done<Result<Stopped>> &done) {
    status([=](const States &states) { end(session, states, done); });
}

/// Those that record it, and what is told of those that an error has stopped.
void SessionRecorder::end(const QString &session, const States &states, const Done<Result<Stopped>> &done) {
    std::vector<SessionCall> active;
    bool isKnown = !states.problems.isEmpty();
    for (const SessionReply &state : states.replies) {
        if (!state.result || (*state.result)["session"].toString() != session)
            continue;
        isKnown = isKnown || (*state.result)["error"].isObject();
        if (isRecording(state))
            active.push_back(stopCall(state.member, session));
    }
    if (active.empty() && !isKnown)
        return done(Error(ErrorCode::NotReady, "nothing is being recorded"));
    callAll(active, "record.stop", stopLimit, this, [=](const SessionReplies &ends) {
        check({session}, ends, [problems = states.problems, done](Stopped checked) {
            checked.problems = problems + checked.problems;
            done(checked);
        });
    });
}

void SessionRecorder::check(const QSet<QString> &ids, const SessionReplies &ends, const Done<Stopped> &done) {
    list([=](const SessionList &found) {
        Stopped checked;
        complete(checked, ids, ends, found);
        done(checked);
    });
}

} // namespace hermes::recorder
