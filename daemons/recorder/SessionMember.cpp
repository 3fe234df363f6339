#include "daemons/recorder/SessionMember.h"

#include "protocol/wire/Fields.h"

#include <QPointer>
#include <memory>

namespace hermes::recorder {
namespace {

/// Replies that come in. Given when nobody holds it any more: each member has answered, or is gone.
struct Round {
    QPointer<QObject> context;
    std::function<void(const SessionReplies &)> done;
    SessionReplies replies;

    ~Round() {
        if (context)
            QMetaObject::invokeMethod(
                context, [done = done, replies = replies] { done(replies); }, Qt::QueuedConnection);
    }
};

} // namespace

bool isLogger(const RobotDaemons::Daemon &daemon) {
    return daemon.commands.contains("record.start");
}

SessionMember memberOf(const RobotDaemons::Daemon &logger) {
    const auto send = [client = QPointer<Client>(logger.client.get())](
                          const QString &method, const QJsonObject &params, const Client::Callback &done,
                          std::chrono::milliseconds timeout) {
        if (client && method == "record.list")
            client->callForMuch(method, params, done, timeout);
        else if (client)
            client->call(method, params, done, timeout);
    };
    const auto has = [&logger](const char *command) { return logger.commands.contains(command); };
    return {logger.name,
            send,
            has("mark"),
            has("source.open"),
            has("source.seek"),
            has("source.speed"),
            has("source.open until_gone"),
            has("record.stop session")};
}

SessionMembers loggersOf(const RobotDaemons &daemons) {
    SessionMembers members;
    for (const auto &[address, daemon] : daemons.all())
        if (daemon->isKnown && isLogger(*daemon))
            members.all.push_back(memberOf(*daemon));
    for (const RobotDaemons::Daemon *daemon : daemons.undescribed())
        members.silent.append(daemon->address + ": it does not say what it can do");
    return members;
}

bool isUnconfirmed(const Result<QJsonValue> &reply) {
    return !reply && (reply.error().is(ErrorCode::TimedOut) || reply.error().is(ErrorCode::Disconnected));
}

RecordingStatus SessionReply::status() const {
    ReadReport report;
    const auto told =
        result ? readMessage<RecordingStatus>(WireValue(*result), report) : std::optional<RecordingStatus>();
    if (told || !result)
        return told.value_or(RecordingStatus());
    RecordingStatus least; // of a logger that tells other things in another form
    least.recording = (*result)["recording"].toBool();
    least.name = (*result)["name"].toString();
    least.session = (*result)["session"].toString();
    return least;
}

SessionCall stopCall(const SessionMember &member, const QString &session) {
    return {member, member.endsOne ? QJsonObject{{"session", session}} : QJsonObject()};
}

void callAll(const std::vector<SessionCall> &calls, const QString &method, std::chrono::milliseconds timeout,
             QObject *context, const std::function<void(const SessionReplies &)> &done) {
    const auto round = std::make_shared<Round>();
    round->context = context;
    round->done = done;
    const Error gone(ErrorCode::Disconnected, method + ": the connection was closed");
    for (const SessionCall &call : calls)
        round->replies.push_back({call.member, gone});
    for (std::size_t i = 0; i < calls.size(); ++i)
        calls[i].member.send(
            method, calls[i].params,
            [round, i](const Result<QJsonValue> &result) { round->replies[i].result = result; }, timeout);
}

std::vector<SessionCall> callsOf(const std::vector<SessionMember> &members, const QJsonObject &params) {
    std::vector<SessionCall> calls;
    for (const SessionMember &member : members)
        calls.push_back({member, params});
    return calls;
}

QStringList complaints(const SessionReplies &replies) {
    QStringList lines;
    for (const SessionReply &reply : replies)
        if (!reply.result)
            lines.append(reply.complaint());
    return lines;
}

Error sessionError(const QString &what, const QStringList &lines) {
    return Error(ErrorCode::NotReady, (QStringList(what) + lines).join("; "));
}

} // namespace hermes::recorder
