#include "gui/desktop/panels/RecordPanel.h"
#include "tests/gui/FakeLogger.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/gui/desktop/TcpLink.h"

using namespace hermes;

/// Replays of several robots, of this window and of others, and what becomes of them when it is closed.
class TestReplayEnds : public QObject {
    Q_OBJECT
private Q_SLOTS:
    /// Two robots with a logger each; the first is chosen.
    void init() {
        fakes_ = std::make_unique<FakeLoggers>();
        open_ = std::make_unique<OpenWindow>();
        for (const char *const name : {"near", "far"}) {
            FakeLogger &logger = fakes_->add(name);
            logger.positionsToEnd = 100000;
        }
        const auto addressOf = [this](std::size_t i) {
            return fakes_->loggers[i]->address().section("//", -1);
        };
        link_ =
            std::make_unique<TcpLink>(addressOf(0).section(':', -1).toUShort(), std::chrono::milliseconds(0));
        QVERIFY(open_->fleet.add(QString("127.0.0.1:%1").arg(link_->port())).ok());
        QVERIFY(open_->fleet.add(addressOf(1)).ok());
        QTRY_VERIFY(robotOf("near") && robotOf("far"));
        open_->fleet.place(robotOf("far")->withName("far"), nullptr);
        QTRY_VERIFY(robotOf("far") != robotOf("near"));
        open_->fleet.rename(*robotOf("near"), "Blue");
        open_->fleet.rename(*robotOf("far"), "Red");
        open_->fleet.choose(robotOf("near"));
        QVERIFY(open_->show());
    }

    void cleanup() {
        open_.reset();
        link_.reset();
        fakes_.reset();
    }

    void othersAreSeenAndGoOn() {
        auto *const banner = open_->window.findChild<QLabel *>("replayBanner");
        QVERIFY(closes()); // nothing is to be said
        QVERIFY(open_->show());
        replay(1);
        QTRY_VERIFY2_WITH_TIMEOUT(watch().whenClosed().contains("goes on: " + title("far")),
                                  qPrintable(watch().whenClosed()), 15000);
        QVERIFY(!watch().isReplaying() && !banner->isVisible()); // the chosen one does not
        QVERIFY(!open_->drive.refusesForReplay());
        QVERIFY(!closes());
        VERIFY_CONTAINS(notice(), "What others replay goes on: " + title("far"));
        open_->fleet.choose(robotOf("far"));
        QVERIFY(watch().isReplaying() && open_->drive.refusesForReplay()); // at once
        QTRY_VERIFY(banner->isVisible());
        open_->drive.driveBlindly();
        QVERIFY(!open_->drive.refusesForReplay());
        replay(0);
        QTRY_VERIFY(watch().whenClosed().contains(title("near")));
        open_->fleet.choose(robotOf("near"));
        QVERIFY(open_->drive.refusesForReplay()); // it was said of the other
        if (!closes())
            QVERIFY(closes());
        QCOMPARE(fakes_->clients[1]->callAndWait("source.status").take()["source"]["state"].toString(),
                 QString("replay"));
        QVERIFY2(fakes_->asked.filter("live").isEmpty(), qPrintable(fakes_->asked.join("; ")));
    }

    void othersAreAskedSeldom() {
        const int &often = fakes_->loggers[0]->questions, &seldom = fakes_->loggers[1]->questions;
        const int before = seldom, beforeChosen = often;
        QTRY_VERIFY_WITH_TIMEOUT(often - beforeChosen >= 20 && seldom > before, 30000);
        QVERIFY2(seldom - before <= (often - beforeChosen) / 4,
                 saying("%1, %2", seldom - before, often - beforeChosen));
    }

    void ownEndsWhicheverIsChosen() {
        play("near");
        replay(1);
        QTRY_VERIFY(watch().isReplaying() && watch().isOwn(*robotOf("near")));
        QVERIFY(!watch().isOwn(*robotOf("far")));
        open_->fleet.choose(robotOf("far"));
        QTRY_VERIFY(watch().isReplaying());
        OpenWindow::click(open_->panel<RecordPanel>("recordings"),
                          "live"); // is of the chosen robot, whoever began it
        QTRY_VERIFY(fakes_->asked.contains("far: live") && !watch().isReplaying());
        QVERIFY(player().isPlaying() && !fakes_->asked.contains("near: live"));
        replay(1);
        QTRY_VERIFY(watch().isReplaying());
        fakes_->asked.clear();
        QVERIFY(!closes());
        VERIFY_STARTS(notice(), title("near") + " still shows a recording; closing ends that replay.");
        VERIFY_CONTAINS(notice(), "goes on: " + title("far"));
        if (!closes())
            QVERIFY(closes());
        QTRY_VERIFY(fakes_->asked.contains("near: live"));
        QTRY_VERIFY(!player().isPlaying());
        QVERIFY(!fakes_->asked.contains("far: live"));
    }

    /// Its answer is not waited for.
    void ownEndsWhileItIsOpened() {
        fakes_->loggers[0]->openDelay_ms = 3000;
        play("near");
        QTRY_VERIFY(watch().isOwn(*robotOf("near")));
        open_->window.leave();
        QVERIFY(!open_->window.isVisible());
        QTRY_VERIFY(fakes_->asked.contains("near: live"));
        QVERIFY(player().isPlaying()); // the answer to its opening has not come
        QTRY_VERIFY_WITH_TIMEOUT(!player().isPlaying(), 10000);
        QCOMPARE(fakes_->loggers[0]->source,
                 QString("live")); // that it was opened after that changes nothing
    }

    /// It plays on, and is still of this window when it is back; until somebody has ended it.
    void ownEndsAfterABrokenLink() {
        for (const bool isEnded : {false, true}) {
            play("near");
            QTRY_VERIFY(fakes_->loggers[0]->source == "replay" && watch().isOwn(*robotOf("near")));
            const DaemonLink *const daemon = robotOf("near")->withName("near");
            link_->cut();
            QTRY_VERIFY(!player().isPlaying());
            QVERIFY(link_->mend());
            QTRY_VERIFY_WITH_TIMEOUT(daemon->isConnected() && watch().isReplaying(), 10000);
            QVERIFY(watch().isOwn(*robotOf("near")));
            if (isEnded) {
                fakes_->loggers[0]->source = "live";
                QTRY_VERIFY(!watch().isOwn(*robotOf("near")));
                replay(0);
                QTRY_VERIFY(watch().isReplaying());
            }
            fakes_->asked.clear();
            open_->window.leave();
            QTRY_VERIFY(!player().isPlaying());
            QCOMPARE(fakes_->asked.contains("near: live"), !isEnded);
            QVERIFY(open_->show());
        }
    }

    void whoPlaysIsNotRemoved() {
        Fleet &fleet = open_->fleet;
        play("far");
        replay(0);
        QTRY_VERIFY(watch().isOwn(*robotOf("far")) && watch().isReplaying());
        const auto refused = fleet.remove(robotOf("far"));
        QVERIFY(!refused);
        QCOMPARE(refused.error().message,
                 title("far") + " shows a recording that is played here: choose it and press Live first.");
        QVERIFY(fleet.remove(robotOf("near")).ok()); // what another client plays there goes on
        player().end();
        QTRY_VERIFY(!player().isPlaying());
        QVERIFY(fleet.remove(robotOf("far")).ok());
        QVERIFY(!fakes_->asked.contains("near: live"));
    }

    void theProgramLeavesTheRobotLive_data() {
        const Rows<QString> row("end");
        row("closed by its window", "close");
        row("told to end", "terminate");
        row("told to end behind a slow link", "slow");
        row("told to end while the logger stands still", "freeze");
    }

    /// The real program, by real keys.
    void theProgramLeavesTheRobotLive() {
        if (QGuiApplication::platformName() != "xcb")
            QSKIP("needs a display: tests/gui/desktop/with_display");
        QFETCH(QString, end);
        open_->window.close();
        RobotProcesses robot;
        robot.startAll();
        Client logger;
        logger.connectTo(QString("127.0.0.1:%1").arg(robot.port("velodynelogger")));
        QVERIFY(logger.waitConnected(std::chrono::seconds(20)).ok());
        const auto source = [&logger] { return logger.callAndWait("source.status").take()["source"]; };
        QVERIFY(logger.callAndWait("record.start", QJsonObject{{"name", "run1"}}).ok());
        const auto bytes = [&logger] {
            return logger.callAndWait("record.status").take()["bytes"].toDouble();
        };
        QTRY_VERIFY_WITH_TIMEOUT(bytes() > 8e6, 60000); // for seconds
        QVERIFY(logger.callAndWait("record.stop").ok());

        const TcpLink link(robot.port("velodynelogger"), std::chrono::milliseconds(150));
        const quint16 port = end == "slow" ? link.port() : robot.port("velodynelogger");
        ChildProcess program;
        program.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-gui",
                      {"--connect", QString("127.0.0.1:%1").arg(port), "--layout", robot.path("gui.json")});
        QVERIFY(program.waitForStarted());
        const auto xdotool = [](const QString &words) {
            QProcess tool;
            tool.start("xdotool", words.split(' '));
            return tool.waitForFinished(20000) && tool.exitCode() == 0;
        };
        const QString comeForward =
            QString("search --onlyvisible --pid %1 --name Hermes windowactivate").arg(program.processId());
        QTRY_VERIFY_WITH_TIMEOUT(xdotool(comeForward), 20000);
        auto time = runningTimer();
        bool plays = false;
        while (!plays && time.elapsed() < 30000) { // as soon as the list is there
            QVERIFY(xdotool(comeForward) && xdotool("key ctrl+7 Return"));
            plays = QTest::qWaitFor([&] { return source()["state"] == "replay"; }, 2000);
        }
        QTRY_COMPARE(source()["paused"].toBool(), false);
        QCOMPARE(source()["state"].toString(), QString("replay"));

        if (end == "freeze")
            robot.signal("velodynelogger", SIGSTOP);
        if (end == "close")
            QVERIFY(xdotool("key ctrl+q") && xdotool("key ctrl+q"));
        else
            program.terminate();
        QTRY_COMPARE_WITH_TIMEOUT(program.state(), QProcess::NotRunning, 10000);
        QCOMPARE(program.exitStatus(), QProcess::NormalExit);
        if (end == "freeze")
            robot.signal("velodynelogger", SIGCONT);
        QTRY_COMPARE(source()["state"].toString(), QString("live"));
    }

private:
    Robot *robotOf(const QString &logger) const {
        for (const auto &robot : open_->fleet.robots())
            if (robot->withName(logger))
                return robot.get();
        return nullptr;
    }
    QString notice() const { return open_->window.findChild<QLabel *>("noticeBanner")->text(); }
    QString title(const QString &logger) const { return open_->fleet.titleOf(*robotOf(logger)); }
    ReplayWatch &watch() const { return open_->drive.replay(); }
    SessionPlayer &player() const { return open_->window.findChild<RecordPanel *>()->player(); }
    /// As another client does.
    void replay(std::size_t logger) {
        QVERIFY(fakes_->clients[logger]->callAndWait("source.open", QJsonObject{{"recording", "x"}}).ok());
    }
    /// As the panel does.
    void play(const QString &logger) {
        DaemonLink *const daemon = robotOf(logger)->withName(logger);
        SessionMembers members;
        QVERIFY(members.add(logger, daemon->client(), [daemon](const QString &method, const QString &) {
            return daemon->hasMethod(method);
        }));
        RecordedSession session;
        session.parts.push_back({members.all.front(), {{"name", "x"}}});
        player().play(session, {});
    }
    bool closes() {
        open_->window.close();
        return !open_->window.isVisible();
    }

    std::unique_ptr<FakeLoggers> fakes_;
    std::unique_ptr<TcpLink> link_; ///< to the first
    std::unique_ptr<OpenWindow> open_;
};
