#include "gui/session/SessionPlayer.h"

#include <algorithm>

namespace hermes {
namespace {

constexpr std::chrono::milliseconds statusPeriod{200};

Result<void> firstError(const SessionReplies &replies) {
    for (const SessionReply &reply : replies)
        if (!reply.result)
            return Error(ErrorCode(reply.result.error().code), reply.complaint());
    return {};
}

} // namespace

SessionPlayer::SessionPlayer(QObject *parent)
    : QObject(parent) {
    timer_.setSingleShot(true);
    connect(&timer_, &QTimer::timeout, this, &SessionPlayer::poll);
}

void SessionPlayer::call(const std::vector<SessionCall> &calls, const QString &method, Next next) {
    callAll(calls, method, options_.timeout, this,
            [this, next](const SessionReplies &replies) { (this->*next)(replies); });
}

void SessionPlayer::play(const RecordedSession &session, const Options &options) {
    if (isPlaying_) {
        end();
        next_ = {session, options};
        return;
    }
    session_ = session;
    options_ = options;
    isPlaying_ = true;
    isEnding_ = false;
    playing_.clear();
    std::vector<SessionMember> players;
    auto &parts = session_.parts;
    parts.erase(std::remove_if(parts.begin(), parts.end(),
                               [](const SessionPart &part) { return !part.member.replays; }),
                parts.end());
    for (const SessionPart &part : parts)
        players.push_back(part.member);
    call(callsOf(players), "record.status", &SessionPlayer::onStates);
}

void SessionPlayer::end() {
    next_.reset();
    isEnding_ = isPlaying_;
    if (timer_.isActive())
        timer_.start(std::chrono::milliseconds(0));
}

/// False: all go live, because of an error or because somebody said so.
bool SessionPlayer::goesOn(const Result<void> &result) {
    if (result && !isEnding_)
        return true;
    goLive(result);
    return false;
}

void SessionPlayer::onStates(const SessionReplies &states) {
    if (states.empty())
        return goLive(sessionError("no logger of this session can replay it", {}));
    for (const SessionReply &state : states)
        if (state.result && (*state.result)["recording"].toBool())
            return goLive(
                Error(ErrorCode::NotReady, QString("%1 is recording \"%2\"; record stop ends it")
                                               .arg(state.member.name, (*state.result)["name"].toString())));
    if (goesOn(firstError(states)))
        open();
}

void SessionPlayer::open() {
    std::vector<SessionCall> calls;
    for (const SessionPart &part : session_.parts)
        calls.push_back({part.member,
                         {{"recording", part.entry["name"]},
                          {"speed", options_.speed},
                          {"paused", true},
                          {"delay_s", part.entry["start"].toDouble() - session_.start}}});
    call(calls, "source.open", &SessionPlayer::onOpened);
}

void SessionPlayer::onOpened(const SessionReplies &replies) {
    const auto isPlayed = [this](const SessionMember &member) { // since the pass before
        return std::any_of(playing_.begin(), playing_.end(),
                           [&](const SessionMember &one) { return one.name == member.name; });
    };
    for (const SessionReply &reply : replies)
        if ((reply.result || reply.result.error().is(ErrorCode::TimedOut)) && !isPlayed(reply.member))
            playing_.push_back(reply.member);
    if (goesOn(firstError(replies)))
        call(callsOf(playing_, {{"paused", false}}), "source.pause", &SessionPlayer::onReleased);
}

void SessionPlayer::onReleased(const SessionReplies &replies) {
    if (goesOn(firstError(replies)))
        poll();
}

void SessionPlayer::poll() {
    call(callsOf(playing_), "source.status", &SessionPlayer::onPositions);
}

void SessionPlayer::onPositions(const SessionReplies &replies) {
    const Result<bool> atEnd = isAtEnd(replies);
    if (!goesOn(atEnd ? Result<void>() : atEnd.error()))
        return;
    if (!*atEnd)
        timer_.start(statusPeriod);
    else if (options_.loop)
        open();
    else
        goLive({});
}

/// Where the logger keeps its part.
QString SessionPlayer::folderOf(const QString &logger) const {
    for (const SessionPart &part : session_.parts)
        if (part.member.name == logger)
            return part.entry["folder"].toString();
    return {};
}

Result<bool> SessionPlayer::isAtEnd(const SessionReplies &replies) {
    if (const Result<void> fine = firstError(replies); !fine)
        return fine.error();
    bool end = true;
    double position_s = 0, duration_s = 0;
    for (const SessionReply &reply : replies) {
        const QString &name = reply.member.name;
        const QJsonValue source = (*reply.result)["source"];
        const QString state = source["state"].toString(), error = source["error"].toString();
        if (!error.isEmpty())
            return Error(ErrorCode::InputOutput, name + ": " + error);
        const QString shown = source["name"].toString();
        const bool isOurs = shown.isEmpty() || folderOf(name).isEmpty() || shown == folderOf(name);
        if ((state != "replay" && state != "ended") || !isOurs) {
            playing_.erase(std::remove_if(playing_.begin(), playing_.end(),
                                          [&](const SessionMember &one) { return one.name == name; }),
                           playing_.end()); // somebody else's now
            return Error(
                ErrorCode::NotReady,
                QString("%1: its source was changed to \"%2\" meanwhile").arg(name, isOurs ? state : shown));
        }
        end = end && state == "ended";
        position_s = std::max(position_s, source["position_s"].toDouble());
        duration_s = std::max(duration_s, source["duration_s"].toDouble());
    }
    Q_EMIT progress(position_s, duration_s);
    return end;
}

void SessionPlayer::goLive(const Result<void> &result) {
    callAll(callsOf(playing_, {{"live", true}}), "source.open", options_.timeout, this,
            [this, result](const SessionReplies &replies) {
                isPlaying_ = false;
                Q_EMIT ended(result ? firstError(replies) : result);
                if (const auto next = std::exchange(next_, std::nullopt); next && !isPlaying_)
                    play(next->first, next->second);
            });
}

} // namespace hermes
