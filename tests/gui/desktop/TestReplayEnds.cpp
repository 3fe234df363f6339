#include "gui/desktop/panels/RecordPanel.h"
#include "tests/gui/FakeLogger.h"
#include "tests/gui/desktop/OpenWindow.h"

#include <QLabel>

using namespace hermes;
using namespace hermes::desktop;

/// Replays of several robots, of this window and of others, and what becomes of them when it is closed.
class TestReplayEnds : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void cleanup();
    void othersAreSeenAndGoOn();
    void othersAreAskedSeldom();
    void ownEndsWhicheverIsChosen();
    void ownEndsWhileItIsOpened();
    void whoPlaysIsNotRemoved();

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
        QVERIFY(members.add(logger, daemon->client(),
                            [daemon](const QString &method) { return daemon->hasMethod(method); }));
        RecordedSession session;
        session.parts.push_back({members.all.front(), {{"name", "x"}}});
        player().play(session, {});
    }
    bool closes() {
        open_->window.close();
        return !open_->window.isVisible();
    }

    std::unique_ptr<FakeRobot> fakes_;
    std::unique_ptr<OpenWindow> open_;
};

/// Two robots with a logger each; the first is chosen.
void TestReplayEnds::init() {
    fakes_ = std::make_unique<FakeRobot>();
    open_ = std::make_unique<OpenWindow>();
    for (const char *const name : {"near", "far"}) {
        FakeLogger &logger = fakes_->add(name);
        logger.positionsToEnd = 100000;
        QVERIFY(open_->fleet.add(logger.address().section("//", -1)).ok());
    }
    QTRY_VERIFY(robotOf("near") && robotOf("far"));
    open_->fleet.place(robotOf("far")->withName("far"), nullptr);
    QTRY_VERIFY(robotOf("far") != robotOf("near"));
    open_->fleet.rename(*robotOf("near"), "Blue");
    open_->fleet.rename(*robotOf("far"), "Red");
    open_->fleet.choose(robotOf("near"));
    QVERIFY(open_->show());
}

void TestReplayEnds::cleanup() {
    open_.reset();
    fakes_.reset();
}

void TestReplayEnds::othersAreSeenAndGoOn() {
    auto *const banner = open_->window.findChild<QLabel *>("replayBanner");
    QVERIFY(closes()); // nothing is to be said
    QVERIFY(open_->show());
    replay(1);
    QTRY_VERIFY2_WITH_TIMEOUT(watch().whenClosed().contains("goes on: " + title("far")),
                              qPrintable(watch().whenClosed()), 15000);
    QVERIFY(!watch().isReplaying() && !banner->isVisible()); // the chosen one does not
    QVERIFY(!open_->drive.refusesForReplay());
    QVERIFY(!closes());
    QVERIFY2(notice().contains("What others replay goes on: " + title("far")), qPrintable(notice()));
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

void TestReplayEnds::othersAreAskedSeldom() {
    const int &often = fakes_->loggers[0]->questions, &seldom = fakes_->loggers[1]->questions;
    const int before = seldom, beforeChosen = often;
    QTRY_VERIFY_WITH_TIMEOUT(often - beforeChosen >= 20 && seldom > before, 30000);
    QVERIFY2(seldom - before <= (often - beforeChosen) / 4,
             qPrintable(QString("%1, %2").arg(seldom - before).arg(often - beforeChosen)));
}

void TestReplayEnds::ownEndsWhicheverIsChosen() {
    play("near");
    replay(1);
    QTRY_VERIFY(watch().isReplaying() && watch().isOwn(*robotOf("near")));
    QVERIFY(!watch().isOwn(*robotOf("far")));
    open_->fleet.choose(robotOf("far"));
    QTRY_VERIFY(watch().isReplaying());
    QVERIFY(!closes());
    QVERIFY2(notice().startsWith(title("near") + " still shows a recording; closing ends that replay."),
             qPrintable(notice()));
    QVERIFY2(notice().contains("goes on: " + title("far")), qPrintable(notice()));
    if (!closes())
        QVERIFY(closes());
    QTRY_VERIFY(fakes_->asked.contains("near: live"));
    QTRY_VERIFY(!player().isPlaying());
    QVERIFY(!fakes_->asked.contains("far: live"));
}

/// Its answer is not waited for.
void TestReplayEnds::ownEndsWhileItIsOpened() {
    fakes_->loggers[0]->openDelay_ms = 3000;
    play("near");
    QTRY_VERIFY(watch().isOwn(*robotOf("near")));
    QElapsedTimer time;
    time.start();
    open_->window.leave();
    QVERIFY(!open_->window.isVisible());
    QTRY_VERIFY(fakes_->asked.contains("near: live"));
    QVERIFY(time.elapsed() < 2000);
    QTRY_VERIFY_WITH_TIMEOUT(!player().isPlaying(), 10000);
    QCOMPARE(fakes_->loggers[0]->source, QString("live")); // that it was opened after that changes nothing
}

void TestReplayEnds::whoPlaysIsNotRemoved() {
    Fleet &fleet = open_->fleet;
    play("far");
    replay(0);
    QTRY_VERIFY(watch().isOwn(*robotOf("far")) && watch().isReplaying());
    const auto refused = fleet.remove(robotOf("far"));
    QVERIFY(!refused);
    QCOMPARE(refused.error().message,
             title("far") + " shows a recording that is played here: press Live first.");
    QVERIFY(fleet.remove(robotOf("near")).ok()); // what another client plays there goes on
    player().end();
    QTRY_VERIFY(!player().isPlaying());
    QVERIFY(fleet.remove(robotOf("far")).ok());
    QVERIFY(!fakes_->asked.contains("near: live"));
}

QTEST_MAIN(TestReplayEnds)
#include "TestReplayEnds.moc"
