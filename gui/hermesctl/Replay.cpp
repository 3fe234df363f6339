#include "gui/hermesctl/Replay.h"

#include "common/daemon/SignalWatcher.h"
#include "gui/hermesctl/Commands.h"

#include <QTimer>
#include <cstdio>
#include <unistd.h>

namespace hermes {
namespace {

constexpr std::chrono::milliseconds statusPeriod{200};

/// The first error among replies, with the name of who gave it.
Result<void> firstError(const Loggers &loggers, const Loggers::Numbers &numbers,
                        const Loggers::Replies &replies) {
    for (std::size_t i = 0; i < replies.size(); ++i) {
        if (!replies[i])
            return Error(ErrorCode(replies[i].error().code),
                         loggers.name(numbers[i]) + QStringLiteral(": ") + replies[i].error().message);
    }
    return {};
}

/// The one that a person means by a name or an id.
Result<Session> theSession(const Loggers &loggers, const QString &word) {
    QStringList problems, found;
    std::optional<Session> match;
    for (const Session &session : findSessions(loggers, problems)) {
        if (session.id != word && session.name != word)
            continue;
        found.append(session.id);
        match = session;
    }
    if (found.size() == 1)
        return *match;
    const QString text =
        match ? QStringLiteral("\"%1\" is the name of %2 sessions, take an id: %3")
                    .arg(word)
                    .arg(found.size())
                    .arg(found.join(QStringLiteral(", ")))
              : QStringLiteral("there is no session \"%1\"; hermesctl record list tells those there are")
                    .arg(word);
    return Error(ErrorCode::NotReady, (QStringList(text) + problems).join(QStringLiteral("; ")));
}

} // namespace

Result<void> replay(const Arguments &arguments) {
    const Result<Loggers> loggers = Loggers::find(arguments);
    if (!loggers)
        return loggers.error();
    const Result<Session> session = theSession(*loggers, arguments.words.first());
    if (!session)
        return session.error();
    for (const QString &line : absentLoggers(*loggers, *session))
        std::fprintf(stderr, "hermesctl: %s\n", qPrintable(line));
    return Replay(*loggers, *session, arguments.speed, arguments.loop).run();
}

Replay::Replay(const Loggers &loggers, const Session &session, double speed, bool loop)
    : loggers_(loggers)
    , session_(session)
    , speed_(speed)
    , loop_(loop) {
    for (const SessionPart &part : session.parts)
        numbers_.push_back(part.logger);
}

Result<void> Replay::run() {
    if (const Result<void> idle = refuseWhileRecording(); !idle)
        return idle;
    SignalWatcher signals(nullptr);
    QObject::connect(&signals, &SignalWatcher::received, &waiting_, [this] {
        interrupted_ = true;
        waiting_.quit();
    });
    Result<void> result;
    do {
        result = begin();
        if (result)
            result = follow();
    } while (result && loop_ && !interrupted_);
    if (shown_)
        std::fputc('\n', stderr);
    const Result<void> live = goLive();
    return result ? live : result;
}

Result<void> Replay::refuseWhileRecording() const {
    const Loggers::Replies states = loggers_.call(numbers_, QStringLiteral("record.status"));
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (states[i] && (*states[i])[QStringLiteral("recording")].toBool())
            return Error(
                ErrorCode::NotReady,
                QStringLiteral("%1 is recording \"%2\"; hermesctl record stop ends it")
                    .arg(loggers_.name(numbers_[i]), (*states[i])[QStringLiteral("name")].toString()));
    }
    return firstError(loggers_, numbers_, states);
}

/// Each opens its part and waits, so that all can begin at once.
Result<void> Replay::begin() {
    std::vector<QJsonObject> params;
    for (const SessionPart &part : session_.parts)
        params.push_back(
            {{QStringLiteral("recording"), part.entry[QStringLiteral("name")]},
             {QStringLiteral("speed"), speed_},
             {QStringLiteral("paused"), true},
             {QStringLiteral("delay_s"), part.entry[QStringLiteral("start")].toDouble() - session_.start}});
    const Loggers::Replies replies = loggers_.callEach(numbers_, QStringLiteral("source.open"), params);
    playing_.clear();
    for (std::size_t i = 0; i < replies.size(); ++i) {
        if (replies[i])
            playing_.push_back(numbers_[i]);
    }
    if (const Result<void> open = firstError(loggers_, numbers_, replies); !open)
        return open;
    return firstError(
        loggers_, numbers_,
        loggers_.call(numbers_, QStringLiteral("source.pause"), {{QStringLiteral("paused"), false}}));
}

Result<void> Replay::follow() {
    while (!interrupted_) {
        const Result<bool> end = isAtEnd();
        if (!end)
            return end.error();
        if (*end)
            break;
        wait();
    }
    return {};
}

Result<bool> Replay::isAtEnd() {
    const Loggers::Replies replies = loggers_.call(numbers_, QStringLiteral("source.status"));
    if (const Result<void> fine = firstError(loggers_, numbers_, replies); !fine)
        return fine.error();
    bool end = true;
    double position_s = 0, duration_s = 0;
    for (std::size_t i = 0; i < replies.size(); ++i) {
        const QJsonValue source = (*replies[i])[QStringLiteral("source")];
        const QString state = source[QStringLiteral("state")].toString();
        const QString error = source[QStringLiteral("error")].toString();
        if (!error.isEmpty())
            return Error(ErrorCode::InputOutput, loggers_.name(numbers_[i]) + QStringLiteral(": ") + error);
        if (state != QStringLiteral("replay") && state != QStringLiteral("ended")) {
            playing_.erase(std::remove(playing_.begin(), playing_.end(), numbers_[i]), playing_.end());
            return Error(ErrorCode::NotReady, QStringLiteral("%1: its source was changed to \"%2\" meanwhile")
                                                  .arg(loggers_.name(numbers_[i]), state));
        }
        end = end && state == QStringLiteral("ended");
        position_s = std::max(position_s, source[QStringLiteral("position_s")].toDouble());
        duration_s = std::max(duration_s, source[QStringLiteral("duration_s")].toDouble());
    }
    showProgress(position_s, duration_s);
    return end;
}

void Replay::wait() {
    QTimer::singleShot(statusPeriod, &waiting_, &QEventLoop::quit);
    waiting_.exec();
}

void Replay::showProgress(double position_s, double duration_s) {
    if (::isatty(STDERR_FILENO) == 0)
        return;
    shown_ = true;
    std::fprintf(stderr, "\r%s: %.1f of %.1f s ", qPrintable(session_.name), position_s, duration_s);
}

Result<void> Replay::goLive() const {
    return firstError(
        loggers_, playing_,
        loggers_.call(playing_, QStringLiteral("source.open"), {{QStringLiteral("live"), true}}));
}

} // namespace hermes
