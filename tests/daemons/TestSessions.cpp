// Loggers that record and replay as one.
#include "daemons/recorder/SessionCommands.h"
#include "daemons/recorder/SessionPlayer.h"
#include "tests/daemons/FakeLogger.h"

using namespace hermes;
using namespace hermes::recorder;

/// What the function that begin() is given is called with.
template <typename T, typename Begin>
static T await(const Begin &begin) {
    std::optional<T> result;
    begin([&result](const T &value) { result = value; });
    QElapsedTimer waited;
    waited.start();
    while (!result && waited.elapsed() < 60000)
        QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents, 100);
    return result.value();
}

class TestSessions : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        Log::instance().setStderr(false);
        timeout_ = slowness * Client::defaultTimeout;
        robot_ = std::make_unique<FakeLoggers>();
        a_ = &robot_->add("a", true);
        b_ = &robot_->add("b", true);
        c_ = &robot_->add("c", false);
    }

    void allBeginOneSessionAndEndIt() {
        QCOMPARE(stop().error().message, QString("nothing is being recorded"));
        const auto begun = start("run1");
        QVERIFY(begun.ok());
        QSet<QString> sessions;
        for (const SessionReply &reply : *begun)
            sessions.insert((*reply.result)["session"].toString());
        QCOMPARE(sessions.size(), 1);
        const auto stopped = stop();
        QVERIFY(stopped.ok());
        QCOMPARE(stopped->problems, QStringList());
        QCOMPARE(stopped->parts.size(), std::size_t(3));
        QVERIFY(!robot_->isRecording());
        // What one misses is told, also when it ended before.
        QVERIFY(start("run2").ok());
        RecordingState state;
        state.losses = {{"lines", 3}};
        a_->writer.setState(state);
        state.error = Error(ErrorCode::InputOutput, "the stick was pulled");
        b_->writer.setState(state);
        QTRY_VERIFY(!b_->recording.isActive());
        const auto ended = stop();
        QVERIFY(ended.ok());
        QCOMPARE(ended->problems, QStringList({"a: lost: lines 3", "b: failed"}));
    }

    void whatIsInTheWayIsTold() {
        record("run1");
        QString told = start("run1").error().message;
        VERIFY_STARTS(told, "nothing was begun; a has a recording \"run1\" already (" + robot_->root.path());
        QVERIFY(start("run2").ok());
        told = start("run3").error().message;
        VERIFY_STARTS(told, "nothing was begun; a records \"run2\" already");
        SessionMembers unsure = members();
        unsure.silent = QStringList("d: it does not say what it is");
        QVERIFY(stop().ok());
        const auto refused =
            await<Result<SessionReplies>>([&](auto done) { startSession(unsure, "run3", "id", this, done); });
        QCOMPARE(refused.error().message, QString("nothing was begun; d: it does not say what it is"));
        c_->writer.refuse = true; // only when it is asked to
        told = start("run3").error().message;
        QVERIFY2(told.contains("c: refused") && told.contains("a had begun and was stopped, see"),
                 qPrintable(told));
        QVERIFY(!robot_->isRecording());
    }

    /// The one that is late is stopped when it has begun at last, the other at once.
    void aStartThatTimesOutIsTakenBack() {
        timeout_ = slowness * std::chrono::milliseconds(300);
        b_->writer.hold = true;
        bool wasActive = false;
        QTimer release;
        connect(&release, &QTimer::timeout, [&] {
            wasActive = wasActive || a_->recording.isActive();
            if (wasActive && !a_->recording.isActive())
                b_->writer.hold = false;
        });
        release.start(1);
        const QString told = start("run1").error().message;
        VERIFY_STARTS(told, "\"run1\" is not recorded; b: record.start: no reply within");
        for (const char *name : {"a", "b", "c"})
            VERIFY_CONTAINS(told, QString("%1 had begun and was stopped").arg(name));
        QVERIFY(!robot_->isRecording());
        QCOMPARE(sidecarOf(robot_->root.path() + "/run1", "b").value("ended").toString(), QString("stopped"));
    }

    void aListSaysWhatASessionHolds() {
        RecordingState state;
        state.bytes = 40;
        state.counts = {{"lines", 4}, {"marks", 0}};
        state.losses = {{"lines", 1}};
        b_->writer.setState(state);
        record("run1");
        QVERIFY(start("run2").ok());
        QVERIFY(QDir(robot_->root.path()).mkpath("odd"));
        put(robot_->root.path() + "/odd/c.json", "{}");
        robot_->clients[0]->close(); // a took part, but does not answer
        const auto found = await<SessionList>([&](auto done) { listSessions(members(), this, done); });
        QCOMPARE(found.sessions.size(), std::size_t(2));
        const RecordedSession &last = found.sessions[0], &first = found.sessions[1];
        QVERIFY(last.goesOn() && last.name == "run2" && last.end == 0);
        QCOMPARE(first.name, QString("run1"));
        QVERIFY(!first.goesOn() && first.end >= first.start && first.start > 1e9);
        QCOMPARE(first.members(), QStringList({"b", "c"}));
        QCOMPARE(first.summary().bytes, 40.0);
        QCOMPARE(first.parts[0].summary().counts, NamedCounts({{"lines", 4}, {"marks", 0}}));
        QCOMPARE(first.problems(),
                 QStringList({"b: lost: lines 1", "a: it took part, but does not answer or was not asked"}));
        QCOMPARE(found.problems.size(), 2);
        QVERIFY(found.problems[0].startsWith("a: record.list: not connected"));
        QVERIFY(found.problems[1].startsWith("c: odd: "));
    }

    void whoIsGoneIsNotWaitedFor() {
        timeout_ = std::chrono::minutes(10);
        b_->writer.hold = true;
        QTimer::singleShot(100, [this] {
            robot_->clients[1].reset(); // the window removes a daemon
            b_->writer.hold = false;
        });
        const QString told = start("run1").error().message;
        VERIFY_CONTAINS(told, "b: record.start: the connection was closed");
    }

    void allAreReleasedTogether() {
        RecordedSession session = record("run1");
        QCOMPARE(session.parts.size(), std::size_t(3));
        for (RecordedPart &part : session.parts)
            part.offset_s += 2; // as if another had begun before
        a_->openDelay_ms = 200;
        a_->positionsToEnd = 1; // the other goes on
        robot_->asked.clear();
        QVERIFY(play(session).ok());
        QCOMPARE(robot_->asked.size(), 6); // c cannot replay
        QCOMPARE(robot_->asked.mid(0, 2), QStringList({"b: opened, waits", "a: opened, waits"}));
        std::sort(robot_->asked.begin() + 2, robot_->asked.begin() + 4); // each in any order
        std::sort(robot_->asked.begin() + 4, robot_->asked.begin() + 6);
        QCOMPARE(robot_->asked.mid(2, 4),
                 QStringList({"a: is released", "b: is released", "a: live", "b: live"}));
        QVERIFY(a_->delay_s >= 2 && a_->delay_s < 3);
        session.parts.erase(session.parts.begin(), session.parts.begin() + 2);
        QCOMPARE(play(session).error().message, QString("no logger of this session can replay it"));
    }

    void aReplayThatFailsEndsForAll_data() {
        const Rows<QString, QString> row("how", "told");
        row("not opened", "error", "b: no such file");
        row("opened late", "late", "b: source.open: no reply within");
        row("recording", "recording", "a is recording \"run2\"; session.stop ends it");
        row("changed by others", "changed", "b: its source was changed to \"live\" meanwhile");
    }

    void aReplayThatFailsEndsForAll() {
        FETCH(QString, how, QString, told);
        const RecordedSession session = record("run1");
        SessionPlayer::Options options;
        options.loop = true;
        if (how == "error")
            b_->openError = "no such file";
        if (how == "recording")
            QVERIFY(start("run2").ok());
        if (how == "late") {
            options.timeout = slowness * std::chrono::milliseconds(200);
            b_->openDelay_ms = slowness * 300;
        }
        if (how == "changed")
            b_->told = {{"state", "live"}};
        robot_->asked.clear();
        const Result<void> result = play(session, options);
        QVERIFY2(!result && result.error().message.startsWith(told),
                 qPrintable(result ? "played" : result.error().message));
        QCOMPARE(a_->source, QString("live"));
        QVERIFY(robot_->asked.contains("a: live") == (how != "recording"));
        if (how == "late") // whatever it was asked before
            QVERIFY(robot_->asked.contains("b: live"));
    }

    void aReplayEndsWhenItIsTold() {
        const RecordedSession session = record("run1");
        SessionPlayer player;
        int positions = 0;
        std::optional<Result<void>> ended;
        connect(&player, &SessionPlayer::progress, [&](double position_s, double duration_s) {
            positions += position_s == 1 && duration_s == 2;
        });
        connect(&player, &SessionPlayer::ended, [&](const Result<void> &result) { ended = result; });
        player.play(session, {1, 0, true, false, timeout_, {}});
        QTRY_VERIFY(positions > 2 * a_->positionsToEnd); // it loops
        QVERIFY(player.isPlaying() && robot_->asked.count("a: is released") > 1);
        player.end();
        QTRY_VERIFY(ended);
        QVERIFY(ended->ok() && !player.isPlaying());
        QVERIFY(a_->source == "live" && b_->source == "live");
    }

    void allGoLiveWhenALaterPassFails() {
        const RecordedSession session = record("run1");
        SessionPlayer player;
        std::optional<Result<void>> ended;
        connect(&player, &SessionPlayer::ended, [&](const Result<void> &result) { ended = result; });
        player.play(session, {1, 0, true, false, timeout_, {}});
        QTRY_COMPARE(robot_->asked.count("a: is released"), 1);
        a_->openError = "the file is gone";
        QTRY_VERIFY(ended);
        QVERIFY(!ended->ok());
        QVERIFY2(a_->source == "live" && b_->source == "live", qPrintable(a_->source + ' ' + b_->source));
    }

    void ordersGoToAll() {
        const RecordedSession session = record("run1");
        SessionPlayer player;
        player.seek(1); // nothing is played
        player.setPaused(true);
        a_->positionsToEnd = b_->positionsToEnd = 1000;
        player.play(session, {1, 0, false, false, timeout_, {}});
        QVERIFY(!player.isPaused());
        QTRY_VERIFY(robot_->asked.contains("a: is released") && robot_->asked.contains("b: is released"));
        robot_->asked.clear();
        player.setPaused(true);
        player.seek(0.5);
        player.setSpeed(4);
        QVERIFY(player.isPaused());
        const auto areIn = [this](const QStringList &expected) {
            QStringList of;
            for (const QString &line : qAsConst(robot_->asked))
                if (line.startsWith("b: "))
                    of.append(line);
            return of == expected && robot_->asked.size() == 2 * expected.size();
        };
        QTRY_VERIFY2(areIn({"b: goes at 4", "b: waits", "b: sought to 0.5"}),
                     qPrintable(robot_->asked.join(", ")));
        QVERIFY(tellTwice(player));
        a_->source = b_->source = "ended"; // it waits there
        QVERIFY(tellTwice(player));
        QVERIFY(player.isPlaying() && player.isPaused());
        player.setPaused(false);
        QTRY_VERIFY(!player.isPlaying());
        QVERIFY(a_->source == "live" && b_->source == "live");
    }

    /// All are opened again, so that they go on together from there.
    void whoHasEndedBeginsAnew() {
        const RecordedSession session = record("run1");
        SessionPlayer player;
        a_->positionsToEnd = 1000;
        b_->positionsToEnd = 1;
        player.play(session, {1, 0, false, false, timeout_, {}});
        QTRY_COMPARE(b_->source, QString("ended"));
        player.setSpeed(2);
        QTRY_COMPARE(a_->speed, 2.0);
        robot_->asked.clear();
        b_->positionsToEnd = 1000;
        player.seek(0.25);
        QTRY_VERIFY(robot_->asked.contains("b: is released"));
        QCOMPARE(b_->source, QString("replay"));
        QCOMPARE(b_->speed, 2.0);
        for (const char *name : {"a", "b"}) {
            const QStringList of = robot_->asked.filter(QRegularExpression(QString("^%1: ").arg(name)));
            QCOMPARE(of.mid(of.size() - 3), QStringList({QString("%1: opened, waits").arg(name),
                                                         QString("%1: sought to 0.25").arg(name),
                                                         QString("%1: is released").arg(name)}));
        }
        robot_->asked.clear();
        b_->told = {{"state", "ended"}}; // it took the seek as it came to its end
        player.seek(0.5);
        QTRY_COMPARE(robot_->asked.count("b: sought to 0.5"), 2);
        QTRY_VERIFY(robot_->asked.contains("b: is released"));
        b_->told = {};
        QVERIFY(tellTwice(player));
        QCOMPARE(robot_->asked.count("b: opened, waits"), 1); // once
        b_->source = "live";                                  // somebody else's
        player.seek(0.75);
        QTRY_VERIFY(!player.isPlaying());
        QCOMPARE(robot_->asked.count("b: opened, waits"), 1);
    }

    void theNewestSeekCounts() {
        const RecordedSession session = record("run1");
        SessionPlayer player;
        bool hasGoneBack = false, isDragged = false;
        connect(&player, &SessionPlayer::progress, [&] { hasGoneBack = hasGoneBack || isDragged; });
        a_->positionsToEnd = b_->positionsToEnd = 1000;
        player.play(session, {1, 0, false, false, timeout_, {}});
        QTRY_VERIFY(robot_->asked.contains("a: is released"));
        robot_->asked.clear();
        isDragged = true;
        for (int i = 1; i <= 500; ++i)
            player.seek(i);
        QVERIFY(!hasGoneBack);
        QTRY_VERIFY(robot_->asked.contains("a: sought to 500"));
        QVERIFY2(robot_->asked.size() <= 6, qPrintable(robot_->asked.join(", ")));
        player.seek(-1);
        player.seek(std::nan(""));
        player.seek(1e300);
        QTRY_VERIFY(robot_->asked.contains("a: sought to 1e+07"));
        player.end();
        QTRY_VERIFY(!player.isPlaying());
    }

    void whatIsImpossibleIsNotKnown() {
        const RecordedSession session = record("run1");
        SessionPlayer player;
        std::vector<std::pair<double, double>> told;
        connect(&player, &SessionPlayer::progress,
                [&](double position_s, double duration_s) { told.emplace_back(position_s, duration_s); });
        a_->told = {{"position_s", 1e300}, {"duration_s", -1e300}, {"paused", "no"}};
        b_->told = {{"position_s", "far"}, {"duration_s", QJsonValue()}};
        player.play(session, {1, 0, false, false, timeout_, {}});
        QTRY_VERIFY(!told.empty() && !player.isPlaying());
        for (const auto &one : told)
            QCOMPARE(one, std::pair(0.0, 0.0));
    }

private:
    /// As a program finds them.
    SessionMembers members() const {
        SessionMembers members;
        members.timeout = timeout_;
        for (std::size_t i = 0; i < robot_->clients.size(); ++i) {
            SessionMember member;
            member.name = QString(QChar('a' + int(i)));
            member.send = [client = QPointer<Client>(robot_->clients[i].get())](
                              const QString &method, const QJsonObject &params, const Client::Callback &done,
                              std::chrono::milliseconds timeout) {
                if (client)
                    client->call(method, params, done, timeout);
            };
            member.endsOne = true;
            member.marks = member.replays = member.seeks = member.setsSpeed = robot_->loggers[i].get() != c_;
            members.all.push_back(member);
        }
        return members;
    }

    Result<SessionReplies> start(const QString &name) {
        const auto begun = await<Result<SessionReplies>>([&](auto done) {
            startSession(members(), name, QUuid::createUuid().toString(QUuid::WithoutBraces), this, done);
        });
        if (begun)
            session_ = (*begun->front().result)["session"].toString();
        return begun;
    }

    Result<EndedSession> stop() {
        return await<Result<EndedSession>>([&](auto done) { stopSession(members(), session_, this, done); });
    }

    RecordedSession record(const QString &name) {
        if (!start(name) || !stop())
            qFatal("nothing is recorded");
        return await<SessionList>([&](auto done) { listSessions(members(), this, done); }).sessions.at(0);
    }

    Result<void> play(const RecordedSession &session, const SessionPlayer::Options &options = {}) {
        SessionPlayer player;
        return await<Result<void>>([&](auto done) {
            QObject::connect(&player, &SessionPlayer::ended, done);
            player.play(session, options);
        });
    }

    /// Where they are, of which the second time they were asked since.
    static bool tellTwice(const SessionPlayer &player) {
        QSignalSpy told(&player, &SessionPlayer::progress);
        return told.wait() && (told.count() > 1 || told.wait());
    }

    std::unique_ptr<FakeLoggers> robot_;
    QString session_; ///< that was begun last
    FakeLogger *a_ = nullptr, *b_ = nullptr, *c_ = nullptr;
    std::chrono::milliseconds timeout_ = Client::defaultTimeout;
};
