#include "gui/desktop/model/LoggerWatch.h"

#include "common/Time.h"

#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr double rateOver_s = 10;

} // namespace

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
    const auto before = std::exchange(members_, {}).all;
    for (DaemonLink *daemon : fleet_.robot() ? fleet_.robot()->daemons() : std::vector<DaemonLink *>())
        if (daemon->isConnected() && daemon->description().isEmpty())
            members_.silent.append(tr("%1: it does not say what it can do").arg(daemon->name()));
        else if (daemon->isConnected())
            members_.add(daemon->name(), daemon->client(),
                         [daemon](const QString &method) { return daemon->hasMethod(method); });
    const bool isSame =
        std::equal(before.begin(), before.end(), members_.all.begin(), members_.all.end(),
                   [](const SessionMember &a, const SessionMember &b) { return a.client == b.client; });
    if (isSame)
        return;
    states_.clear();
    progress_.clear();
    poll();
    Q_EMIT membersChanged();
    Q_EMIT changed();
}

void LoggerWatch::poll() {
    for (const SessionMember &member : members_.all) // one by one: none is to wait for another
        callAll({{member, {}}}, "record.status", members_.timeout, this,
                [this](const SessionReplies &replies) {
                    const SessionReply &reply = replies.front();
                    for (const SessionMember &known : members_.all)
                        if (known.client == reply.member.client && reply.result)
                            states_[known.name] = reply.result->toObject();
                    Q_EMIT changed();
                });
    const double now = monotonicNow();
    if (!isRecording())
        return progress_.clear();
    progress_.emplace_back(now, bytes());
    while (progress_.front().first < now - rateOver_s)
        progress_.pop_front();
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

bool LoggerWatch::marks() const {
    return std::any_of(members_.all.begin(), members_.all.end(), [this](const SessionMember &member) {
        const auto state = states_.find(member.name);
        return member.marks && state != states_.end() && state->second["recording"].toBool();
    });
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
    for (const QJsonObject &state : recording())
        longest = std::max(longest, stampNow() - state["start"].toDouble());
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
