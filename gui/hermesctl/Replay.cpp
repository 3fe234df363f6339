// hermesctl replay: all loggers of a session play it back.
#include "common/daemon/SignalWatcher.h"
#include "common/platform/Console.h"
#include "common/progress/Progress.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Loggers.h"
#include "gui/hermesctl/Waiting.h"
#include "gui/session/SessionPlayer.h"
#include "gui/session/SessionRecorder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace hermes::ctl {
namespace {

/// The one that a person means by a name or an id.
Result<RecordedSession> theSession(const SessionList &list, const QString &word) {
    QStringList found;
    const RecordedSession *match = nullptr;
    for (const RecordedSession &session : list.sessions) {
        if (session.id != word && session.name != word)
            continue;
        found.append(session.id);
        match = &session;
    }
    if (found.size() == 1)
        return *match;
    const QString text =
        match ? QString("\"%1\" is the name of %2 sessions, take an id: %3")
                    .arg(word)
                    .arg(found.size())
                    .arg(found.join(", "))
              : QString("there is no session \"%1\"; hermesctl record list tells those there are").arg(word);
    return sessionError(text, list.problems);
}

} // namespace

Result<void> replay(const Arguments &arguments) {
    const Result<Loggers> loggers = Loggers::find(arguments);
    if (!loggers)
        return loggers.error();
    if (const QStringList &silent = loggers->members.silent;
        !arguments.daemons.isEmpty() && !silent.isEmpty())
        return sessionError("nothing is replayed", silent);
    SessionRecorder recorder(loggers->members);
    const auto list = [&] {
        const Waiting waiting(arguments.timeout);
        return await<SessionList>([&](auto done) { recorder.list(0, done); });
    }();
    const Result<RecordedSession> session = theSession(list, arguments.words.first());
    if (!session)
        return session.error();
    for (const QString &line : session->absent())
        note(line);
    SessionPlayer player;
    SignalWatcher signals(nullptr);
    QObject::connect(&signals, &SignalWatcher::received, &player, &SessionPlayer::end);
    std::optional<Progress> progress;
    double last_s = 0;
    bool shown = false;
    QObject::connect(&player, &SessionPlayer::progress, [&](double position_s, double duration_s) {
        if (arguments.json) {
            printJson(QJsonObject{
                {"session", session->id}, {"position_s", position_s}, {"duration_s", duration_s}});
            if (!progress || position_s < std::exchange(last_s, position_s)) // --loop begins anew
                progress.emplace("replaying, second");
            progress->update(position_s, duration_s);
        } else if (isTerminal(StandardStream::Errors)) {
            shown = true;
            std::fprintf(stderr, "\r\033[K%s: %.1f of %.1f s, %.0f s left ",
                         qPrintable(printable(session->name)), position_s, duration_s,
                         std::ceil(std::max(0.0, duration_s - position_s) / arguments.speed));
        }
    });
    const auto result = await<Result<void>>([&](auto done) {
        QObject::connect(&player, &SessionPlayer::ended, done);
        player.play(*session, {arguments.speed, arguments.loop, arguments.timeout});
    });
    if (shown)
        std::fputc('\n', stderr);
    return result;
}

} // namespace hermes::ctl
