#include "gui/desktop/model/RecordingStop.h"

#include <algorithm>

namespace hermes::desktop {
namespace {

QString addressOf(const Robot &robot, const SessionMember &member) {
    for (DaemonLink *const daemon : robot.daemons())
        if (&daemon->client() == member.client)
            return daemon->address();
    return {};
}

} // namespace

RecordingStop::RecordingStop(Fleet &fleet, const QString &title, QObject *parent)
    : QObject(parent)
    , fleet_(fleet)
    , title_(title) {
    connect(&timer_, &QTimer::timeout, this, &RecordingStop::resume);
    timer_.start(std::chrono::seconds(1));
}

void RecordingStop::begin(const LoggerWatch &watch) {
    tells_ = true;
    sessions_ += watch.sessions();
    for (const SessionMember &member : watch.recordingMembers().all) {
        const QString address = fleet_.robot() ? addressOf(*fleet_.robot(), member) : QString();
        const auto known = loggers_.find(address);
        if (!address.isEmpty() && (known == loggers_.end() || known->second.state != State::Told))
            tell(address, member, watch.states().at(member.name)["session"]);
    }
}

void RecordingStop::expect(const QString &session, const QString &address, const SessionMember &logger) {
    sessions_.insert(session);
    loggers_.insert({address, {logger, State::Unconfirmed, {}}});
}

bool RecordingStop::isOf(const Robot *robot) const {
    const std::vector<Robot *> all = robots();
    return std::find(all.begin(), all.end(), robot) != all.end();
}

/// Whose they are now: a daemon may turn out to be of another robot.
std::vector<Robot *> RecordingStop::robots() const {
    std::vector<Robot *> found;
    for (const auto &[address, logger] : loggers_) {
        Robot *const robot = fleet_.robotOf(fleet_.daemonAt(address));
        if (robot && std::find(found.begin(), found.end(), robot) == found.end())
            found.push_back(robot);
    }
    return found;
}

QStringList RecordingStop::silent() const {
    QStringList names;
    for (const auto &[address, logger] : loggers_) {
        const DaemonLink *const daemon = fleet_.daemonAt(address);
        if (logger.state != State::Answered && daemon && daemon->isSilent())
            names.append(logger.member.name);
    }
    return names;
}

void RecordingStop::resume() {
    const std::vector<Robot *> all = robots();
    if (all.empty()) {
        timer_.stop();
        const bool doubt =
            isUnderWay() || std::any_of(loggers_.begin(), loggers_.end(), [](const auto &logger) {
                return logger.second.state != State::Answered;
            });
        return Q_EMIT removed(doubt);
    }
    for (const Robot *const robot : all)
        for (const SessionMember &member : loggersOf(*robot).all)
            ask(addressOf(*robot, member), member);
    checkWhenAnswered();
    Q_EMIT changed();
}

/// One that was away may record as well.
void RecordingStop::ask(const QString &address, const SessionMember &member) {
    if (asked_.contains(address) || !mayBeAsked(address))
        return;
    asked_.insert(address);
    const auto told = [this, address](const SessionReplies &replies) {
        asked_.remove(address);
        if (replies.front().result) // else it is asked again
            take(address, replies.front().member, replies.front().result->toObject());
    };
    callAll({{member, {}}}, "record.status", Client::defaultTimeout, this, told);
}

void RecordingStop::take(const QString &address, const SessionMember &member, const QJsonObject &state) {
    if (!mayBeAsked(address)) // told meanwhile
        return;
    if (state["recording"].toBool() && ends(state["session"].toString()))
        return tell(address, member, state["session"]);
    const auto known = loggers_.find(address);
    if (known == loggers_.end())
        return;
    known->second.state = State::Answered; // its sidecar tells how it ended
    isToCheck_ = true;
    checkWhenAnswered();
}

/// It was not told, or has not confirmed it.
bool RecordingStop::mayBeAsked(const QString &address) const {
    const auto known = loggers_.find(address);
    return known == loggers_.end() || known->second.state == State::Unconfirmed;
}

void RecordingStop::tell(const QString &address, const SessionMember &member, const QJsonValue &session) {
    loggers_[address] = {member, State::Told, {}};
    isToCheck_ = true;
    callAll({stopCall(member, session.toString())}, "record.stop", SessionRecorder::stopLimit, this,
            [this, address](const SessionReplies &replies) {
                take(loggers_.at(address), replies.front().result);
                checkWhenAnswered();
            });
}

void RecordingStop::take(Logger &logger, const Result<QJsonValue> &reply) {
    const auto is = [&](ErrorCode code) { return !reply && reply.error().is(code); };
    logger.state = isUnconfirmed(reply) ? State::Unconfirmed : State::Answered;
    if (!isUnconfirmed(reply) && !is(ErrorCode::NotReady)) // it had ended before: its sidecar tells how
        logger.end = reply;
}

bool RecordingStop::isWaitedFor(const QString &address, const Logger &logger) const {
    const DaemonLink *const daemon = fleet_.daemonAt(address);
    return logger.state == State::Told ||
           (logger.state == State::Unconfirmed && daemon && daemon->isConnected());
}

void RecordingStop::checkWhenAnswered() {
    const auto isWaitedFor = [this](const auto &one) { return this->isWaitedFor(one.first, one.second); };
    if (!isToCheck_ || isChecking_ || std::any_of(loggers_.begin(), loggers_.end(), isWaitedFor))
        return;
    isToCheck_ = false;
    isChecking_ = true;
    SessionMembers members;
    for (const Robot *const robot : robots()) {
        const SessionMembers loggers = loggersOf(*robot);
        members.all.insert(members.all.end(), loggers.all.begin(), loggers.all.end());
        members.silent += loggers.silent;
    }
    recorder_.setMembers(members);
    recorder_.check(sessions_, takeEnds(members), [this](const SessionRecorder::Stopped &stopped) {
        isChecking_ = false;
        QStringList problems = stopped.problems;
        for (const auto &[address, logger] : loggers_)
            if (logger.state == State::Unconfirmed)
                problems.append(
                    tr("%1 has not confirmed that it stopped: it may still record").arg(logger.member.name));
        if (tells_)
            Q_EMIT ended(problems);
        checkWhenAnswered();
    });
}

/// Under the names that the members have now.
SessionReplies RecordingStop::takeEnds(const SessionMembers &members) {
    SessionReplies ends;
    for (auto &[address, logger] : loggers_) {
        if (!logger.end)
            continue;
        for (const SessionMember &member : members.all)
            if (member.client == logger.member.client)
                logger.member = member;
        ends.push_back({logger.member, *std::exchange(logger.end, std::nullopt)});
    }
    return ends;
}

} // namespace hermes::desktop
