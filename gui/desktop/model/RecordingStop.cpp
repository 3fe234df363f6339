#include "gui/desktop/model/RecordingStop.h"

namespace hermes::desktop {
namespace {

QString addressOf(const SessionMember &member) {
    return member.client ? member.client->address() : QString();
}

} // namespace

RecordingStop::RecordingStop(LoggerWatch &watch, QObject *parent)
    : QObject(parent)
    , watch_(watch) {
    connect(&watch, &LoggerWatch::changed, this, &RecordingStop::goOn);
}

void RecordingStop::begin() {
    sessions_ += watch_.sessions();
    answered_.clear();
    unconfirmed_.clear();
    goOn();
}

/// Loggers that record what is to end.
std::vector<SessionMember> RecordingStop::unanswered() const {
    std::vector<SessionMember> found;
    for (const SessionMember &member : watch_.recordingMembers().all)
        if (sessions_.contains(watch_.states().at(member.name)["session"].toString()) &&
            !answered_.contains(addressOf(member)))
            found.push_back(member);
    return found;
}

QStringList RecordingStop::waitingFor() const {
    QStringList names;
    for (const SessionMember &member : unanswered())
        names.append(member.name);
    return names;
}

void RecordingStop::goOn() {
    if (checks_)
        return;
    for (const SessionMember &member : unanswered()) {
        const QString address = addressOf(member);
        if (told_.contains(address))
            continue;
        isUnderWay_ = true;
        told_.insert(address);
        callAll({{member, {}}}, "record.stop", SessionRecorder::stopLimit, this,
                [this, address](const SessionReplies &replies) { take(address, replies.front()); });
    }
    if (isUnderWay_ && told_.isEmpty())
        check();
}

void RecordingStop::take(const QString &address, const SessionReply &reply) {
    told_.remove(address);
    const auto is = [&](ErrorCode code) { return !reply.result && reply.result.error().is(code); };
    if (is(ErrorCode::TimedOut) || is(ErrorCode::Disconnected)) {
        unconfirmed_[address] = reply.member.name;
    } else {
        unconfirmed_.remove(address);
        answered_.insert(address);
        if (!is(ErrorCode::NotReady)) // it had ended before: its sidecar tells how
            ends_.push_back(reply);
    }
    watch_.poll();
    goOn();
}

void RecordingStop::check() {
    checks_ = true;
    recorder_.setMembers(watch_.members());
    recorder_.check(sessions_, std::exchange(ends_, {}), [this](const SessionRecorder::Stopped &stopped) {
        checks_ = isUnderWay_ = false;
        QStringList problems = stopped.problems; // of another robot's loggers, when that was chosen meanwhile
        for (const QString &name : qAsConst(unconfirmed_))
            problems.append(tr("%1 has not confirmed that it stopped: it may still record").arg(name));
        Q_EMIT ended(problems);
        goOn();
    });
}

} // namespace hermes::desktop
