#include "daemons/recorder/SessionPlayer.h"

#include <algorithm>

namespace hermes::recorder {
namespace {

constexpr std::chrono::milliseconds statusPeriod{200};
constexpr double longest_s = 1e7;  // as source.seek takes it
constexpr double lastPart_s = 0.3; // of a recording: who was sought to it may be at its end

Result<void> firstError(const SessionReplies &replies) {
    for (const SessionReply &reply : replies)
        if (!reply.result)
            return Error(ErrorCode(reply.result.error().code), reply.complaint());
    return {};
}

bool isNotReady(const SessionReply &reply) {
    return !reply.result && reply.result.error().is(ErrorCode::NotReady);
}

/// One that has come to its end takes no orders; if it is not that, source.status will tell.
Result<void> firstRefusal(SessionReplies replies) {
    replies.erase(std::remove_if(replies.begin(), replies.end(), isNotReady), replies.end());
    return firstError(replies);
}

/// A source that shows what was recorded: at the end of a replay it still does.
bool isReplay(const QJsonValue &source) {
    const QString state = source["state"].toString();
    return state == "replay" || state == "ended";
}

/// Whether a source shows what lies in a folder, as far as both are told.
bool isOf(const QString &folder, const QJsonValue &source) {
    const QString shown = source["name"].toString();
    return shown.isEmpty() || folder.isEmpty() || shown == folder;
}

/// Seconds as they can be; 0: not known.
double secondsOf(const QJsonValue &value) {
    const double seconds = value.toDouble();
    return seconds >= 0 && seconds <= longest_s ? seconds : 0;
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
    session_ = session;
    options_ = options;
    isPlaying_ = true;
    isEnding_ = false;
    isPaused_ = options.paused;
    reopens_ = false;
    seekWanted_ = speedWanted_ = std::nullopt;
    pauseWanted_.reset();
    begin_s_ = options.from_s;
    sought_s_.reset();
    playing_.clear();
    std::vector<SessionMember> players;
    auto &parts = session_.parts;
    parts.erase(std::remove_if(parts.begin(), parts.end(),
                               [](const RecordedPart &part) { return !part.member.replays; }),
                parts.end());
    for (const RecordedPart &part : parts)
        players.push_back(part.member);
    call(callsOf(players), "record.status", &SessionPlayer::onStates);
}

void SessionPlayer::end() {
    isEnding_ = isPlaying_;
    obeySoon();
}

void SessionPlayer::obeySoon() {
    if (timer_.isActive()) // else a reply is waited for
        timer_.start(std::chrono::milliseconds(0));
}

/// A line for each logger that lacks what is asked for.
Result<void> SessionPlayer::haveAll(bool SessionMember::*what, const QString &text) const {
    QStringList lines;
    for (const RecordedPart &part : session_.parts)
        if (!(part.member.*what))
            lines.append(part.member.name + ": " + text);
    return lines.isEmpty() ? Result<void>() : sessionError("the replay goes on as it was", lines);
}

Result<void> SessionPlayer::seek(double t_s) {
    const Result<void> fine = haveAll(&SessionMember::seeks, "it cannot seek");
    if (!isPlaying_ || !fine || !(t_s >= 0))
        return fine;
    seekWanted_ = std::min(t_s, longest_s);
    obeySoon();
    return {};
}

void SessionPlayer::setPaused(bool isPaused) {
    if (!isPlaying_)
        return;
    pauseWanted_ = isPaused;
    obeySoon();
}

Result<void> SessionPlayer::setSpeed(double speed) {
    const Result<void> fine = haveAll(&SessionMember::setsSpeed, "it cannot change its speed");
    if (!isPlaying_ || !fine)
        return fine;
    options_.speed = speed; // of those that are opened anew, too
    speedWanted_ = speed;
    obeySoon();
    return {};
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
        if (const RecordingStatus status = state.status(); status.recording)
            return goLive(
                Error(ErrorCode::NotReady, QString("%1 is recording \"%2\"; session.stop ends it")
                                               .arg(state.member.name, status.name.value_or(QString()))));
    if (goesOn(firstError(states)))
        open();
}

void SessionPlayer::open() {
    std::vector<SessionCall> calls;
    for (const RecordedPart &part : session_.parts) {
        QJsonObject params{{"recording", part.entry.name},
                           {"speed", options_.speed},
                           {"paused", true},
                           {"delay_s", part.offset_s}};
        if (part.member.endsWithUs)
            params.insert("until_gone", true);
        calls.push_back({part.member, params});
    }
    call(calls, "source.open", &SessionPlayer::onOpened);
}

void SessionPlayer::onOpened(const SessionReplies &replies) {
    const auto isPlayed = [this](const SessionMember &member) { // since the pass before
        return std::any_of(playing_.begin(), playing_.end(),
                           [&](const SessionMember &one) { return one.name == member.name; });
    };
    for (const SessionReply &reply : replies)
        if ((reply.result || isUnconfirmed(reply.result)) && !isPlayed(reply.member))
            playing_.push_back(reply.member);
    if (!goesOn(firstError(replies)))
        return;
    if (begin_s_ > 0)
        order("source.seek", {{"t_s", begin_s_}}, &SessionPlayer::onPlaced);
    else
        onPlaced({});
}

void SessionPlayer::onPlaced(const SessionReplies &replies) {
    if (!goesOn(firstRefusal(replies)))
        return;
    if (isPaused_)
        poll();
    else
        order("source.pause", {{"paused", false}}, &SessionPlayer::onObeyed);
}

void SessionPlayer::order(const QString &method, const QJsonObject &params, Next next) {
    call(callsOf(playing_, params), method, next);
}

void SessionPlayer::orderPause() {
    isPaused_ = *std::exchange(pauseWanted_, std::nullopt);
    order("source.pause", {{"paused", isPaused_}}, &SessionPlayer::onObeyed);
}

void SessionPlayer::onObeyed(const SessionReplies &replies) {
    if (goesOn(firstRefusal(replies)))
        poll();
}

void SessionPlayer::onSought(const SessionReplies &replies) {
    reopens_ = std::any_of(replies.begin(), replies.end(), isNotReady);
    if (!reopens_)
        sought_s_ = begin_s_;
    onObeyed(replies);
}

/// What was ordered meanwhile is done, then they are asked where they are. They wait before they are sought
/// and go on after it.
void SessionPlayer::poll() {
    if (const auto speed = std::exchange(speedWanted_, std::nullopt))
        return order("source.speed", {{"speed", *speed}}, &SessionPlayer::onObeyed);
    if (pauseWanted_ == true)
        return orderPause();
    if (const auto t_s = std::exchange(seekWanted_, std::nullopt)) {
        begin_s_ = *t_s;
        return order("source.seek", {{"t_s", *t_s}}, &SessionPlayer::onSought);
    }
    if (pauseWanted_ && !reopens_)
        return orderPause();
    order("source.status", {}, &SessionPlayer::onPositions);
}

void SessionPlayer::onPositions(const SessionReplies &replies) {
    const Result<bool> atEnd = isAtEnd(replies);
    if (!goesOn(atEnd ? Result<void>() : atEnd.error()))
        return;
    sought_s_.reset(); // once
    if (std::exchange(reopens_, false))
        return open();
    begin_s_ = 0;
    if (!*atEnd || isPaused())
        timer_.start(hasOrders() ? std::chrono::milliseconds(0) : statusPeriod);
    else if (options_.loop)
        open();
    else
        goLive({});
}

bool SessionPlayer::hasOrders() const {
    return seekWanted_ || speedWanted_ || pauseWanted_;
}

/// Where the logger keeps its part.
QString SessionPlayer::folderOf(const QString &logger) const {
    for (const RecordedPart &part : session_.parts)
        if (part.member.name == logger)
            return part.entry.folder.value_or(QString());
    return {};
}

Result<bool> SessionPlayer::isAtEnd(const SessionReplies &replies) {
    if (const Result<void> fine = firstError(replies); !fine)
        return fine.error();
    bool end = true;
    std::optional<bool> isPaused;
    double position_s = 0, duration_s = 0;
    for (const SessionReply &reply : replies) {
        const QString &name = reply.member.name;
        const QJsonValue source = (*reply.result)["source"];
        const QString state = source["state"].toString(), error = source["error"].toString();
        if (!error.isEmpty())
            return Error(ErrorCode::InputOutput, name + ": " + error);
        const bool isOurs = isOf(folderOf(name), source);
        if (!isReplay(source) || !isOurs) {
            playing_.erase(std::remove_if(playing_.begin(), playing_.end(),
                                          [&](const SessionMember &one) { return one.name == name; }),
                           playing_.end()); // somebody else's now
            return Error(ErrorCode::NotReady, QString("%1: its source was changed to \"%2\" meanwhile")
                                                  .arg(name, isOurs ? state : source["name"].toString()));
        }
        end = end && state == "ended";
        // It was about to end as it was sought.
        reopens_ = reopens_ || (state == "ended" && sought_s_ &&
                                *sought_s_ < secondsOf(source["duration_s"]) - lastPart_s);
        if (state == "replay" && source["paused"].isBool())
            isPaused = isPaused.value_or(true) && source["paused"].toBool();
        position_s = std::max(position_s, secondsOf(source["position_s"]));
        duration_s = std::max(duration_s, secondsOf(source["duration_s"]));
    }
    isPaused_ = isPaused.value_or(isPaused_); // others may let them wait, too
    if (!seekWanted_ && !reopens_)
        Q_EMIT progress(position_s, duration_s);
    return end;
}

void SessionPlayer::goLive(const Result<void> &result) {
    isPlaying_ = true;
    callAll(callsOf(playing_, {{"live", true}}), "source.open", options_.timeout, this,
            [this, result](const SessionReplies &replies) {
                isPlaying_ = false;
                playing_.clear();
                Q_EMIT ended(result ? firstError(replies) : result);
            });
}

} // namespace hermes::recorder
