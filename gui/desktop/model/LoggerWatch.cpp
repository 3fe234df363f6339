#include "gui/desktop/model/LoggerWatch.h"

#include "common/Time.h"

#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr double rateOver_s = 10;

} // namespace

SessionMembers loggersOf(const Robot &robot) {
    SessionMembers members;
    for (DaemonLink *daemon : robot.daemons())
        if (daemon->isConnected() && daemon->description().isEmpty())
            members.silent.append(LoggerWatch::tr("%1: it does not say what it can do").arg(daemon->name()));
        else if (daemon->isConnected())
            members.add(daemon->name(), daemon->client(),
                        [daemon](const QString &method, const QString &param) {
                            return param.isEmpty() ? daemon->hasMethod(method) : daemon->takes(method, param);
                        });
    return members;
}

LoggerWatch::LoggerWatch(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&fleet, &Fleet::changed, this, &LoggerWatch::follow);
    connect(&fleet, &Fleet::robotChosen, this, &LoggerWatch::follow);
    connect(&timer_, &QTimer::timeout, this, &LoggerWatch::poll);
    timer_.start(std::chrono::seconds(1));
    follow();
}

void LoggerWatch::follow() {
    const bool isOther = std::exchange(robot_, fleet_.robot()) != fleet_.robot();
    const auto before = std::exchange(members_, robot_ ? loggersOf(*robot_) : SessionMembers()).all;
    const bool isSame =
        std::equal(before.begin(), before.end(), members_.all.begin(), members_.all.end(),
                   [](const SessionMember &a, const SessionMember &b) { return a.client == b.client; });
    const QStringList wereSilent = std::exchange(silent_, silent());
    if (isSame && !isOther) {
        if (wereSilent != silent_)
            Q_EMIT changed();
        return;
    }
    if (isOther) {
        states_.clear();
        lost_.clear();
    }
    drop(before);
    progress_.clear();
    poll();
    Q_EMIT membersChanged();
    Q_EMIT changed();
}

/// What is known of those that went.
void LoggerWatch::drop(const std::vector<SessionMember> &before) {
    for (const SessionMember &member : before) {
        const bool isHere =
            std::any_of(members_.all.begin(), members_.all.end(), [&](const SessionMember &one) {
                return one.client == member.client && one.name == member.name;
            });
        const auto state = states_.find(member.name);
        if (isHere || state == states_.end())
            continue;
        if (state->second["recording"].toBool())
            lost_[member.name] = {state->second["name"].toString(), state->second["session"].toString(),
                                  false};
        states_.erase(state);
    }
}

void LoggerWatch::poll() {
    for (const SessionMember &member : members_.all) // one by one: none is to wait for another
        callAll({{member, {}}}, "record.status", members_.timeout, this,
                [this](const SessionReplies &replies) { take(replies.front()); });
    const double now = monotonicNow();
    if (!isRecording())
        return progress_.clear();
    if (std::exchange(isHeard_, false)) // else nothing is known of it
        progress_.emplace_back(now, bytes());
    while (!progress_.empty() && progress_.front().first < now - rateOver_s)
        progress_.pop_front();
}

void LoggerWatch::take(const SessionReply &reply) {
    for (const SessionMember &known : members_.all) {
        if (known.client != reply.member.client || !reply.result)
            continue;
        const QJsonObject now = reply.result->toObject();
        heard_[known.name] = stampNow();
        isHeard_ = true;
        compare(known.name, std::exchange(states_[known.name], now), now);
    }
    Q_EMIT changed();
}

/// Whether what it recorded goes on.
void LoggerWatch::compare(const QString &logger, const QJsonObject &before, const QJsonObject &now) {
    const auto lost = lost_.find(logger);
    const bool wasGone = lost != lost_.end() && !lost->second.isBack;
    if (!wasGone && !before["recording"].toBool())
        return;
    const Lost was =
        wasGone ? lost->second : Lost{before["name"].toString(), before["session"].toString(), false};
    const QString session = now["session"].toString();
    if (session != was.session && (wasGone || session.isEmpty())) // it knows of none: it began anew
        lost_[logger] = {was.recording, was.session, true};
    else if (wasGone)
        lost_.erase(lost); // the link was away, not the logger
    if (session != was.session || !now["recording"].toBool())
        Q_EMIT ended(was.session, was.recording);
}

void LoggerWatch::forgetLost() {
    lost_.clear();
    Q_EMIT changed();
}

std::vector<QJsonObject> LoggerWatch::recording() const {
    std::vector<QJsonObject> found;
    for (const auto &[name, state] : states_)
        if (state["recording"].toBool())
            found.push_back(state);
    return found;
}

QStringList LoggerWatch::silent() const {
    QStringList names;
    if (fleet_.robot())
        for (const DaemonLink *daemon : fleet_.robot()->allWithMethod("record.status"))
            if (daemon->isSilent())
                names.append(daemon->name());
    return names;
}

SessionMembers LoggerWatch::recordingMembers(bool onlyMarkers) const {
    SessionMembers found;
    found.timeout = members_.timeout;
    for (const SessionMember &member : members_.all) {
        const auto state = states_.find(member.name);
        if (state != states_.end() && state->second["recording"].toBool() && (member.marks || !onlyMarkers))
            found.all.push_back(member);
    }
    return found;
}

QSet<QString> LoggerWatch::sessions() const {
    QSet<QString> ids;
    for (const QJsonObject &state : recording())
        ids.insert(state["session"].toString());
    return ids;
}

int LoggerWatch::markCount() const {
    double most = 0;
    for (const QJsonObject &state : recording())
        most = std::max(most, state["counts"].toObject()["marks"].toDouble());
    return int(std::min(most, 1e6));
}

QString LoggerWatch::name() const {
    const std::vector<QJsonObject> active = recording();
    return active.empty() ? QString() : active.front()["name"].toString();
}

double LoggerWatch::bytes() const {
    double sum = 0;
    for (const QJsonObject &state : recording())
        sum += state["bytes"].toDouble();
    return sum;
}

double LoggerWatch::seconds() const {
    double longest = 0;
    for (const auto &[name, state] : states_)
        if (state["recording"].toBool())
            longest = std::max(longest, heard_.at(name) - state["start"].toDouble());
    return longest;
}

double LoggerWatch::secondsLeft() const {
    double least = -1;
    for (const auto &[name, state] : states_)
        if (const QJsonValue free = state["free_bytes"]; free.isDouble())
            least = least < 0 ? free.toDouble() : std::min(least, free.toDouble());
    if (least < 0 || progress_.size() < 2)
        return -1;
    const auto &[t0, bytes0] = progress_.front();
    const auto &[t1, bytes1] = progress_.back();
    return bytes1 > bytes0 && t1 > t0 ? least * (t1 - t0) / (bytes1 - bytes0) : -1;
}

} // namespace hermes::desktop
