#include "daemons/recorder/SessionControl.h"

#include "common/Log.h"
#include "common/Time.h"
#include "common/recording/RecordingName.h"
#include "common/schema/SchemaValidator.h"
#include "protocol/wire/Fields.h"

#include <QDateTime>
#include <QJsonArray>
#include <QUuid>
#include <algorithm>

namespace hermes::recorder {
namespace {

constexpr double rateOver_s = 10;
constexpr std::size_t maxMarks = 1000; // that are told
constexpr int maxProblems = 100;

} // namespace

SessionControl::SessionControl(RobotDaemons &daemons, const SessionMember &own)
    : daemons_(daemons)
    , own_(own) {
    connect(&daemons, &RobotDaemons::came, this, &SessionControl::greet);
    connect(&daemons, &RobotDaemons::went, this, [this](RobotDaemons::Daemon *daemon) {
        logWarning("daemons", daemon->name + goneText);
        Q_EMIT changed();
    });
    connect(&daemons, &RobotDaemons::missed, this, &SessionControl::missed);
    connect(&second_, &QTimer::timeout, this, &SessionControl::watch);
    connect(&player_, &SessionPlayer::progress, this, [this](double position_s, double duration_s) {
        position_s_ = position_s;
        length_s_ = duration_s;
        Q_EMIT changed();
    });
    connect(&player_, &SessionPlayer::ended, this, [this](const Result<void> &result) {
        if (!result)
            problem("replay: " + result.error().message);
        Q_EMIT changed();
        for (const auto &done : std::exchange(toBeLive_, {}))
            done(state());
    });
}

SessionMembers SessionControl::allMembers() const {
    SessionMembers all = loggersOf(daemons_);
    all.all.insert(all.all.begin(), own_);
    return all;
}

/// Those that take part.
SessionMembers SessionControl::members() const {
    SessionMembers members = allMembers();
    const auto isLeftOut = [this](const SessionMember &member) {
        return !what_.isEmpty() && !what_.contains(member.name) && member.name != own_.name;
    };
    members.all.erase(std::remove_if(members.all.begin(), members.all.end(), isLeftOut), members.all.end());
    if (!what_.isEmpty())
        members.silent.clear(); // no others take part
    return members;
}

void SessionControl::problem(const QString &line) {
    logWarning("session", line);
    if (now_.problems.size() < maxProblems && !now_.problems.contains(line))
        now_.problems.append(line);
    Q_EMIT changed();
}

void SessionControl::start(const QString &name, const QStringList &what, const Done<SessionState> &done) {
    const QString full = name.isEmpty() ? QDateTime::currentDateTime().toString("yyyy-MM-dd_HH-mm-ss") : name;
    if (const Result<void> fine = checkName("name", full); !fine)
        return done(fine.error());
    if (isBusy())
        return done(Error(ErrorCode::NotReady,
                          QString("\"%1\" is being recorded; session.stop ends it").arg(now_.name)));
    if (isReplaying())
        return done(Error(ErrorCode::NotReady,
                          QString("\"%1\" is replayed; session.live ends that").arg(player_.session().name)));
    for (const QString &one : what)
        if (RobotDaemons::Daemon *const daemon = daemons_.find(one);
            one != own_.name && (!daemon || !isLogger(*daemon)))
            return done(invalidParams({{"what", one, "the name of a logger that answers"}},
                                      QString("what: no logger \"%1\" answers").arg(one)));
    phase_ = Phase::Starting;
    daemons_.forgetSilent();
    what_ = what;
    forget(full);
    Q_EMIT changed();
    const QString id = now_.session = QUuid::createUuid().toString(QUuid::WithoutBraces);
    startSession(members(), full, id, this, [this, id, done](const Result<SessionReplies> &begin) {
        if (begin) {
            phase_ = Phase::Recording;
            begun(*begin);
            return askHowTheyAre([this, done] { done(state()); });
        }
        phase_ = Phase::Idle;
        ended_.insert(id);
        Q_EMIT sessionEnded(id);
        now_.name.clear();
        now_.session.clear();
        Q_EMIT changed();
        done(begin.error());
    });
}

/// Of the session before; one of this name follows.
void SessionControl::forget(const QString &name) {
    now_ = {};
    now_.name = name;
    parts_.clear();
    free_.clear();
    progress_.clear();
}

/// A logger whose device is not there records nothing, and says so in its health only.
void SessionControl::askHowTheyAre(const std::function<void()> &done) {
    callAll(callsOf(members().all), "daemon.status", std::chrono::seconds(3), this,
            [this, done](const SessionReplies &replies) {
                for (const SessionReply &reply : replies)
                    for (const QJsonValue &item :
                         reply.result ? (*reply.result)["health"].toArray() : QJsonArray())
                        if (item["level"].toString() != "ok")
                            now_.notes.append(QString("%1: %2: %3: %4")
                                                  .arg(reply.member.name, item["level"].toString(),
                                                       item["name"].toString(), item["message"].toString()));
                Q_EMIT changed();
                done();
            });
}

void SessionControl::begun(const SessionReplies &replies) {
    startMono_ = monotonicNow();
    now_.start = stampNow();
    for (const SessionReply &reply : replies)
        keep(reply);
    logInfo("session", QString("\"%1\" is recorded by %2 daemons").arg(now_.name).arg(parts_.size()));
    second_.start(std::chrono::seconds(1));
    for (const auto &[address, daemon] : daemons_.all()) // who came in between
        if (daemon->isKnown && parts_.count(daemon->name) == 0)
            greet(daemon.get());
}

/// What a logger tells of its part.
void SessionControl::keep(const SessionReply &reply) {
    const QString &name = reply.member.name;
    const RecordingStatus status = reply.status();
    const bool isOfIt = status.session == now_.session, isOn = status.recording && isOfIt;
    const QString error = status.error ? status.error->message : QString();
    SessionPart &part = parts_[name];
    if (!isOn && part.state == "recording" && phase_ == Phase::Recording)
        problem(
            QString("%1 does not record any more%2").arg(name, error.isEmpty() ? QString() : ": " + error));
    const QString state = isOn ? "recording" : error.isEmpty() ? "stopped" : "failed";
    if (isOfIt)
        part = sessionPart(name, state, error, status.bytes, status.counts, status.losses);
    else
        part.state = "failed";
    if (status.freeBytes)
        free_[name] = *status.freeBytes;
}

void SessionControl::watch() {
    if (phase_ != Phase::Recording)
        return tellLate();
    now_.duration_s = monotonicNow() - startMono_;
    callAll(callsOf(members().all), "record.status", std::chrono::seconds(3), this,
            [this](const SessionReplies &states) { take(states); });
}

void SessionControl::take(const SessionReplies &states) {
    if (phase_ != Phase::Recording)
        return;
    double bytes = 0;
    for (const SessionReply &state : states) {
        if (state.status().session != now_.session && parts_.count(state.member.name) == 0)
            continue;
        if (state.result)
            keep(state);
        else
            parts_[state.member.name].state = "silent";
        bytes += parts_[state.member.name].bytes;
    }
    for (auto &[name, part] : parts_)
        if (name != own_.name && !daemons_.find(name))
            part.state = "silent";
    progress_.emplace_back(monotonicNow(), bytes);
    while (progress_.front().first < progress_.back().first - rateOver_s)
        progress_.pop_front();
    Q_EMIT changed();
}

void SessionControl::stop(const Done<SessionState> &done) {
    if (phase_ != Phase::Recording)
        return done(
            Error(ErrorCode::NotReady, phase_ == Phase::Idle
                                           ? QString("nothing is being recorded")
                                           : QString("\"%1\" is about to begin or to end").arg(now_.name)));
    phase_ = Phase::Stopping;
    ended_.insert(now_.session); // whatever becomes of this process meanwhile
    Q_EMIT sessionEnded(now_.session);
    now_.duration_s = monotonicNow() - startMono_;
    Q_EMIT changed();
    stopSession(members(), now_.session, this, [this, done](const Result<EndedSession> &result) {
        ended(result);
        done(state());
    });
}

void SessionControl::ended(const Result<EndedSession> &result) {
    phase_ = Phase::Idle;
    second_.start(std::chrono::seconds(1));
    if (!result)
        problem(result.error().message);
    std::map<QString, SessionPart> parts;
    for (const RecordedPart &part : result ? result->parts : std::vector<RecordedPart>())
        parts[part.member.name] = part.summary();
    for (const auto &[name, part] : parts_)
        if (parts.count(name) == 0) {
            parts[name] = part;
            if (part.state != "recording" && part.state != "silent")
                continue; // it is told already why
            parts[name].state = "silent";
            late_.insert(name);
            problem(name + ": it took part, and does not answer; it is told to stop when it does");
        }
    parts_ = std::move(parts);
    for (const QString &line : result ? result->problems : QStringList())
        problem(line);
    logInfo("session", QString("\"%1\" has ended").arg(now_.name));
    progress_.clear();
    Q_EMIT changed();
}

/// What a daemon tells and nobody can record.
void SessionControl::missed(const QString &line) {
    if (phase_ == Phase::Recording)
        problem(line);
    else
        logWarning("session", line);
}

Result<SessionMark> SessionControl::mark(const QString &text) {
    if (phase_ != Phase::Recording)
        return Error(ErrorCode::NotReady, "nothing is being recorded; session.start begins");
    const SessionMark mark{monotonicNow() - startMono_, text};
    if (now_.marks.size() < maxMarks)
        now_.marks.push_back(mark);
    std::vector<SessionCall> calls;
    for (const SessionMember &member : members().all)
        if (member.marks && parts_.count(member.name) != 0)
            calls.push_back({member, {{"text", text}}});
    callAll(calls, "mark", Client::defaultTimeout, this, [this](const SessionReplies &replies) {
        for (const QString &line : complaints(replies))
            problem("a mark is missing: " + line);
    });
    Q_EMIT changed();
    return mark;
}

void SessionControl::list(const WhenDone<SessionList> &done) {
    listSessions(allMembers(), this, done);
}

void SessionControl::find(const QString &name, const Done<RecordedSession> &done) {
    list([name, done](const SessionList &list) {
        for (const RecordedSession &session : list.sessions)
            if (session.name == name || session.id == name)
                return done(session);
        done(invalidParams({{"name", name, "the name of a session"}},
                           QString("name: there is no session \"%1\"; session.list names them").arg(name)));
    });
}

SessionState SessionControl::state() const {
    SessionState state = now_;
    static const char *const phases[]{"idle", "starting", "recording", "stopping"};
    state.state = phases[int(phase_)];
    if (phase_ == Phase::Recording)
        state.duration_s = monotonicNow() - startMono_;
    for (const auto &[name, part] : parts_) {
        state.parts.push_back(part);
        state.bytes += part.bytes;
    }
    for (const auto &[name, bytes] : free_)
        state.free_bytes = std::min(bytes, state.free_bytes.value_or(bytes));
    if (state.free_bytes && progress_.size() > 1) {
        const auto &[t0, bytes0] = progress_.front();
        const auto &[t1, bytes1] = progress_.back();
        if (bytes1 > bytes0 && t1 > t0)
            state.left_s = *state.free_bytes * (t1 - t0) / (bytes1 - bytes0);
    }
    if (phase_ == Phase::Recording)
        state.silent = daemons_.silent();
    if (isReplaying()) {
        state.state = "replaying";
        state.name = player_.session().name;
        state.session = player_.session().id;
        state.start = player_.session().start;
        state.replay = SessionReplay{position_s_, length_s_, player_.options().speed, player_.isPaused(),
                                     player_.options().loop};
    }
    return state;
}

} // namespace hermes::recorder
