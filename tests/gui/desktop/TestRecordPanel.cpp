#include "common/client/DaemonAddress.h"
#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/panels/RecordPanel.h"
#include "tests/gui/FakeLogger.h"
#include "tests/gui/desktop/OpenWindow.h"

#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>

using namespace hermes;
using namespace hermes::desktop;

/// Records what the simulated lidar sends, with a serial logger beside it, and replays it.
class TestRecordPanel : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void recordsAsOneAndReplays();
    void aStartThatTimesOutIsTakenBack();
    void aReplayIsShownAndDrivingAsks();

private:
    template <typename T>
    T *find(const QString &name) const {
        return panel_->findChild<T *>(name);
    }
    void click(const QString &button) { QTest::mouseClick(find<QPushButton>(button), Qt::LeftButton); }
    QString message() const { return find<QLabel>("message")->text(); }

    std::unique_ptr<RecordPanel> panel_;
};

void TestRecordPanel::recordsAsOneAndReplays() {
    RobotProcesses robot;
    robot.startAll();
    robot.start("seriallogger", {"record.folder=" + robot.path("recordings")});
    Fleet fleet;
    robot.connectTo(fleet);
    panel_ = std::make_unique<RecordPanel>(fleet);
    panel_->show();
    QTRY_VERIFY(find<QLabel>("amount")->text().contains("velodynelogger") &&
                find<QLabel>("amount")->text().contains("seriallogger"));

    find<QLineEdit>("name")->setText("first");
    click("record");
    QTRY_COMPARE(message(), QString("Recording first."));
    QTRY_COMPARE(find<QPushButton>("record")->text(), QString("S&top"));
    QTRY_VERIFY_WITH_TIMEOUT(find<QLabel>("amount")->text().contains("the disk will do for"), 15000);
    QTRY_VERIFY(find<QPushButton>("mark")->isVisible());
    find<QLineEdit>("markText")->setText("at the door");
    click("mark");
    QTRY_COMPARE(message(), QString("Marked: at the door"));
    click("record");
    QTRY_COMPARE(find<QPushButton>("record")->text(), QString("Re&cord"));
    QTRY_VERIFY2(message().contains("nothing missing"), qPrintable(message()));
    QVERIFY(!find<QPushButton>("mark")->isVisible());
    QFile events(robot.path("recordings") + "/first/seriallogger-events.jsonl");
    QVERIFY(events.open(QIODevice::ReadOnly));
    QVERIFY(events.readAll().contains("\"text\":\"at the door\""));

    auto *const sessions = find<QTreeWidget>("sessions");
    QTRY_COMPARE(sessions->topLevelItemCount(), 1); // both loggers, one session
    QCOMPARE(sessions->topLevelItem(0)->text(0), QString("first"));
    const auto toolTip = [&] { return sessions->topLevelItem(0)->toolTip(0); };
    QTRY_VERIFY2(toolTip().contains("seriallogger: ") && toolTip().contains("marks 1, complete") &&
                     toolTip().contains("velodynelogger: data "),
                 qPrintable(toolTip()));

    click("record"); // the same name once more
    QTRY_VERIFY(message().startsWith("nothing was begun; "));
    QTRY_COMPARE(find<QPushButton>("record")->text(), QString("Re&cord"));

    sessions->setCurrentItem(sessions->topLevelItem(0));
    QTRY_VERIFY(find<QPushButton>("replay")->isEnabled());
    DaemonLink *const lidar = fleet.robot()->withName("velodynelogger");
    const auto state = [lidar] {
        return lidar->client()
            .callAndWait("source.status")
            ->toObject()["source"]
            .toObject()["state"]
            .toString();
    };
    click("replay");
    QTRY_COMPARE(state(), QString("replay"));
    QTRY_VERIFY(find<QPushButton>("live")->isEnabled());
    click("live");
    QTRY_COMPARE(state(), QString("live"));
    click("replay");
    QTRY_COMPARE(state(), QString("replay"));
    QTRY_COMPARE_WITH_TIMEOUT(state(), QString("live"), 15000); // played to its end
    QTRY_VERIFY(!find<QPushButton>("live")->isEnabled());
    sessions->setCurrentItem(sessions->topLevelItem(0)); // the chosen one goes with its loggers
    robot.signal("velodynelogger", SIGSTOP);
    QTRY_VERIFY(find<QLabel>("amount")->text().startsWith("velodynelogger does not answer"));
    robot.kill("velodynelogger");
    robot.kill("seriallogger");
    QTRY_COMPARE(sessions->topLevelItemCount(), 0);
    QVERIFY(!find<QPushButton>("replay")->isEnabled());
    panel_.reset();
}

/// As with hermesctl: see TestSessions.
void TestRecordPanel::aStartThatTimesOutIsTakenBack() {
    FakeRobot robot;
    FakeLogger &prompt = robot.add("prompt"), &late = robot.add("late");
    Fleet fleet;
    for (const auto &logger : robot.loggers)
        QVERIFY(fleet.add(logger->address().section("//", -1)).ok());
    panel_ = std::make_unique<RecordPanel>(fleet);
    panel_->show();
    QTRY_VERIFY(find<QLabel>("amount")->text().contains("prompt") &&
                find<QLabel>("amount")->text().contains("late"));
    late.writer.hold = true;
    click("record");
    QTRY_VERIFY(prompt.recording.isActive());
    QTRY_VERIFY_WITH_TIMEOUT(!prompt.recording.isActive(), 15000);
    late.writer.hold = false;
    QTRY_VERIFY2(message().contains("late: record.start: no reply within 5 s") &&
                     message().contains("late had begun and was stopped"),
                 qPrintable(message()));
    QVERIFY(!robot.isRecording());
    panel_.reset();
}

// Begun by somebody else: the window says so all the same.
void TestRecordPanel::aReplayIsShownAndDrivingAsks() {
    RobotProcesses robot;
    robot.startAll();
    OpenWindow open(robot);
    QVERIFY(open.show());
    QTRY_VERIFY(open.drive.isPossible());
    const auto label = [&](const char *name) { return open.window.findChild<QLabel *>(name); };
    const auto button = [&](const char *name) { return open.window.findChild<QPushButton *>(name); };
    QVERIFY(!label("replayBanner")->isVisible());
    Client somebody, motors;
    somebody.connectTo(asOwner(QString("127.0.0.1:%1").arg(robot.port("velodynelogger"))));
    motors.connectTo(QString("127.0.0.1:%1").arg(robot.port("motorcontrol")));
    QVERIFY(somebody.waitConnected().ok() && motors.waitConnected().ok());
    const auto speed = [&] {
        return motors.callAndWait("motor.state")->toObject()["target"].toObject()["vx"].toDouble();
    };
    QTRY_VERIFY_WITH_TIMEOUT(motors.callAndWait("motor.state")->toObject()["ready"].toBool(), 10000);
    QTRY_VERIFY(open.window.map().model().pose());
    QVERIFY(somebody.callAndWait("record.start", QJsonObject{{"name", "once"}}).ok());
    QTest::qWait(1500);
    QVERIFY(somebody.callAndWait("record.stop").ok());

    QTest::keyPress(&open.window, Qt::Key_W);
    QTRY_VERIFY(speed() > 0.1);
    QVERIFY(somebody.callAndWait("source.open", QJsonObject{{"recording", "once"}, {"loop", true}}).ok());
    QTRY_VERIFY_WITH_TIMEOUT(label("replayBanner")->isVisible(), 1000);
    QTRY_VERIFY2(label("replayBanner")->text().contains("velodynelogger replays"),
                 qPrintable(label("replayBanner")->text()));
    QTRY_COMPARE(speed(), 0.0); // the drive that was under way has ended
    QTest::keyRelease(&open.window, Qt::Key_W);
    QTest::keyPress(&open.window, Qt::Key_W);
    QTest::qWait(300);
    QCOMPARE(speed(), 0.0);
    QTRY_VERIFY2(label("problem")->text().contains("A replay is shown"),
                 qPrintable(label("problem")->text()));
    QTest::keyRelease(&open.window, Qt::Key_W);
    OpenWindow::click(&open.window, "driveBlindly");
    QTest::keyPress(&open.window, Qt::Key_W);
    QTRY_VERIFY2(speed() > 0.1, qPrintable(open.drive.problem()));
    QTest::keyRelease(&open.window, Qt::Key_W);
    DaemonLink *const matcher = open.fleet.robot()->withName("scanmatcher");
    const auto isKept = [matcher] {
        const auto &health = matcher->status().health;
        return std::any_of(health.begin(), health.end(), [](const HealthItem &item) {
            return item.name == "replay" && item.message.contains("the live map is kept");
        });
    };
    QTRY_VERIFY(isKept());

    QVERIFY(somebody.callAndWait("source.open", QJsonObject{{"live", true}}).ok());
    QTRY_VERIFY(!label("replayBanner")->isVisible());
    QVERIFY(!button("driveBlindly")->isVisible());
    QTRY_VERIFY(!isKept());
}

QTEST_MAIN(TestRecordPanel)
#include "TestRecordPanel.moc"
