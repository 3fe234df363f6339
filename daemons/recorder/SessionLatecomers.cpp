// Loggers that come later, come back, or go on by themselves, and the session.
#include "common/Log.h"
#include "common/Time.h"
#include "daemons/recorder/SessionControl.h"

namespace hermes::recorder {

/// A logger that is there now, for the first time or again.
void SessionControl::greet(RobotDaemons::Daemon *daemon) {
    Q_EMIT changed();
    if (!isLogger(*daemon))
        return;
    callAll({{memberOf(*daemon), {}}}, "record.status", Client::defaultTimeout, this,
            [this](const SessionReplies &replies) { join(replies.front()); });
}

/// A logger tells what it records.
void SessionControl::join(const SessionReply &reply) {
    if (!reply.result)
        return;
    const SessionMember &member = reply.member;
    const RecordingStatus status = reply.status();
    const QString session = status.session.value_or(QString());
    if (status.recording && ended_.contains(session))
        return callAll({stopCall(member, session)}, "record.stop", stopLimit, this,
                       [this, member](const SessionReplies &) {
                           logInfo("session", member.name + " was away, and is told to stop");
                       });
    if (status.recording && phase_ == Phase::Idle)
        return resume(status);
    if (phase_ != Phase::Recording || session == now_.session ||
        (!what_.isEmpty() && !what_.contains(member.name)))
        return;
    callAll({{member, {{"name", now_.name}, {"session", now_.session}}}}, "record.start",
            Client::defaultTimeout, this, [this](const SessionReplies &replies) {
                if (!replies.front().result)
                    return problem("it was not there all the time, and does not record: " +
                                   replies.front().complaint());
                keep(replies.front());
                Q_EMIT changed();
            });
}

void SessionControl::resume(const RecordingStatus &status) {
    const QString name = status.name.value_or(QString()), session = status.session.value_or(QString());
    if (phase_ != Phase::Idle || isReplaying() || ended_.contains(session))
        return;
    phase_ = Phase::Starting;
    what_.clear();
    forget(name);
    now_.session = session;
    callAll(
        {{own_, {{"name", name}, {"session", session}}}}, "record.start", Client::defaultTimeout, this,
        [=](const SessionReplies &replies) {
            const bool isOwn = replies.front().result.ok();
            phase_ = isOwn || status.recording ? Phase::Recording : Phase::Idle;
            if (!isOwn)
                problem(QString("\"%1\" was not stopped, and this recorder cannot go on with it: %2")
                            .arg(name, replies.front().complaint()));
            if (phase_ == Phase::Idle)
                return;
            begun(isOwn ? replies : SessionReplies()); // else the loggers record alone, and can be stopped
            now_.start = status.start.value_or(0);
            const double own_s = replies.front().status().duration_s.value_or(0);
            startMono_ -= std::max(own_s, status.duration_s.value_or(std::max(0.0, stampNow() - now_.start)));
            watch();
            if (!isOwn)
                return;
            Q_EMIT resumed(name);
            problem("the recorder was away, or not there at the beginning; what it records is missing then");
        });
}

/// Who took part and did not answer as the session was ended.
void SessionControl::tellLate() {
    if (late_.isEmpty())
        return second_.stop();
    for (const SessionMember &member : allMembers().all)
        if (late_.contains(member.name))
            callAll({{member, {}}}, "record.status", std::chrono::seconds(3), this,
                    [this, member](const SessionReplies &replies) {
                        if (replies.front().result && late_.remove(member.name))
                            join(replies.front());
                    });
}

} // namespace hermes::recorder
