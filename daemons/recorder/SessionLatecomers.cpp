// Loggers that come later, come back, or go on by themselves, and the session.
#include "common/Log.h"
#include "common/Time.h"
#include "daemons/recorder/SessionControl.h"

namespace hermes::recorder {

/// A logger that is there now, for the first time or again.
void SessionControl::greet(RobotDaemons::Daemon *daemon) {
    Q_EMIT changed();
    if (!daemon->isLogger())
        return;
    const SessionMember member = daemon->member();
    callAll({{member, {}}}, "record.status", Client::defaultTimeout, this,
            [this, member](const SessionReplies &replies) {
                if (replies.front().result)
                    join(member, *replies.front().result);
            });
}

void SessionControl::join(const SessionMember &member, const QJsonValue &status) {
    const QString session = status["session"].toString();
    if (status["recording"].toBool() && ended_.contains(session))
        return callAll({stopCall(member, session)}, "record.stop", SessionRecorder::stopLimit, this,
                       [this, member](const SessionReplies &) {
                           logInfo("session", member.name + " was away, and is told to stop");
                       });
    if (status["recording"].toBool() && phase_ == Phase::Idle)
        return resume(status);
    if (phase_ != Phase::Recording || session == session_ ||
        (!what_.isEmpty() && !what_.contains(member.name)))
        return;
    callAll({{member, {{"name", name_}, {"session", session_}}}}, "record.start", Client::defaultTimeout,
            this, [this, member](const SessionReplies &replies) {
                if (!replies.front().result)
                    return problem("it was not there all the time, and does not record: " +
                                   replies.front().complaint());
                keep(member, *replies.front().result);
                Q_EMIT changed();
            });
}

/// The recorder was killed, or ended, while the loggers recorded: it goes on with its part.
void SessionControl::resume(const QJsonValue &status) {
    const QString name = status["name"].toString(), session = status["session"].toString();
    phase_ = Phase::Starting;
    callAll({{own_, {{"name", name}, {"session", session}}}}, "record.start", Client::defaultTimeout, this,
            [=](const SessionReplies &replies) {
                phase_ = replies.front().result ? Phase::Recording : Phase::Idle;
                if (!replies.front().result)
                    return problem(QString("\"%1\" is being recorded, but not by this recorder: %2")
                                       .arg(name, replies.front().complaint()));
                name_ = name;
                begun(replies);
                start_ = status["start"].toDouble();
                startMono_ -= std::max(0.0, stampNow() - start_);
                Q_EMIT resumed(name);
                watch();
                problem(
                    "the recorder was away, or not there at the beginning; what it records is missing then");
            });
}

/// Who took part and did not answer as the session was ended.
void SessionControl::tellLate() {
    if (late_.isEmpty())
        return second_.stop();
    for (const SessionMember &member : daemons_.loggers().all)
        if (late_.contains(member.name))
            callAll({{member, {}}}, "record.status", std::chrono::seconds(3), this,
                    [this, member](const SessionReplies &replies) {
                        if (replies.front().result && late_.remove(member.name))
                            join(member, *replies.front().result);
                    });
}

} // namespace hermes::recorder
