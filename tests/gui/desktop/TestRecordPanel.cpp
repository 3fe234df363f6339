#include "common/client/DaemonAddress.h"
#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/panels/SessionTable.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/gui/desktop/RecordPanelFixture.h"

using namespace hermes;

/// Records what the simulated lidar sends, with a serial logger beside it, and replays it.
class TestRecordPanel : public QObject, RecordPanelFixture {
    Q_OBJECT
private Q_SLOTS:
    void recordsAsOneAndReplays() {
        RobotProcesses robot;
        robot.startAll();
        robot.start("seriallogger", {"record.folder=" + robot.path("recordings")});
        Fleet fleet;
        robot.connectTo(fleet);
        open(fleet, {"velodynelogger", "seriallogger"});

        OpenWindow::type(find<QLineEdit>("name"), "first");
        click("record");
        QTRY_COMPARE(message(), QString("Recording first."));
        QTRY_COMPARE(button("record"), QString("S&top"));
        QTRY_VERIFY_WITH_TIMEOUT(text("amount").contains("the disk will do for"), 15000);
        QTRY_VERIFY(find<QPushButton>("mark")->isVisible());
        QTRY_COMPARE(find<QTreeWidget>("sessions")->topLevelItemCount(), 1);
        Q_EMIT find<QTreeWidget>("sessions")
            ->itemActivated(find<QTreeWidget>("sessions")->topLevelItem(0), 0);
        VERIFY_CONTAINS(message(), "nothing is replayed");
        find<QLineEdit>("markText")->setText("at the door");
        click("mark");
        QTRY_COMPARE(message(), QString("Marked: at the door"));
        click("record");
        QTRY_COMPARE(button("record"), QString("Re&cord"));
        TRY_CONTAINS(message(), "nothing missing");
        QVERIFY(!find<QPushButton>("mark")->isVisible());
        QVERIFY(contentOf(robot.path("recordings") + "/first/seriallogger-events.jsonl")
                    .contains("\"text\":\"at the door\""));

        auto *const sessions = find<QTreeWidget>("sessions");
        QTRY_COMPARE(sessions->topLevelItemCount(), 1); // both loggers, one session
        QCOMPARE(sessions->topLevelItem(0)->text(0), QString("first"));
        const auto toolTip = [&] { return sessions->topLevelItem(0)->toolTip(0); };
        QTRY_VERIFY2(toolTip().contains("seriallogger: ") && toolTip().contains("marks 1, complete") &&
                         toolTip().contains("velodynelogger: data "),
                     qPrintable(toolTip()));

        QTRY_COMPARE(find<QLineEdit>("name")->text(), QString("first2")); // the next one
        OpenWindow::type(find<QLineEdit>("name"), "first");               // the same name once more
        click("record");
        QTRY_VERIFY(message().startsWith("nothing was begun; "));
        QTRY_COMPARE(button("record"), QString("Re&cord"));

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
        QTRY_VERIFY(text("amount").startsWith("velodynelogger does not answer"));
        robot.kill("velodynelogger");
        robot.kill("seriallogger");
        QTRY_COMPARE(sessions->topLevelItemCount(), 0);
        QVERIFY(!find<QPushButton>("replay")->isEnabled());
    }

    /// As with hermesctl: see TestSessions.
    void aStartThatTimesOutIsTakenBack() {
        FakeLoggers robot;
        FakeLogger &prompt = robot.add("prompt"), &late = robot.add("late");
        Fleet fleet;
        open(fleet, robot);
        late.writer.hold = true;
        click("record");
        QTRY_VERIFY(prompt.recording.isActive());
        QTRY_VERIFY_WITH_TIMEOUT(!prompt.recording.isActive(), 15000);
        late.writer.hold = false;
        QTRY_VERIFY2(message().contains("late: record.start: no reply within 5 s") &&
                         message().contains("late had begun and was stopped"),
                     qPrintable(message()));
        QVERIFY(!robot.isRecording());
        const auto *const sessions = find<QTreeWidget>("sessions");
        QTRY_VERIFY(sessions->topLevelItemCount() == 1 && sessions->topLevelItem(0)->text(2) != "goes on");
        VERIFY_CONTAINS(message(), "late had begun and was stopped");
    }

    // Begun by somebody else: the window says so all the same.
    void aReplayIsShownAndDrivingAsks() {
        RobotProcesses robot;
        robot.startAll();
        OpenWindow open(robot);
        QVERIFY(open.show());
        QTRY_VERIFY(open.drive.isPossible());
        const auto label = [&](const char *name) { return open.window.findChild<QLabel *>(name); };
        const auto button = [&](const char *name) { return open.window.findChild<QPushButton *>(name); };
        QVERIFY(!label("replayBanner")->isVisible());
        ConnectedClient somebody(asOwner(QString("127.0.0.1:%1").arg(robot.port("velodynelogger"))));
        ConnectedClient motors(QString("127.0.0.1:%1").arg(robot.port("motorcontrol")));
        const auto speed = [&] {
            return motors.callAndWait("motor.state")->toObject()["target"].toObject()["vx"].toDouble();
        };
        QTRY_VERIFY_WITH_TIMEOUT(motors.callAndWait("motor.state")->toObject()["ready"].toBool(), 10000);
        QTRY_VERIFY(open.window.map().model().pose());
        QVERIFY(somebody.callAndWait("record.start", QJsonObject{{"name", "once"}}).ok());
        QTest::qWait(1500);
        QVERIFY(somebody.callAndWait("record.stop").ok());

        // A machine that stands still for a moment ends a drive.
        const auto drives = [&] {
            for (int tries = 0; tries < 4; ++tries) {
                QTest::keyPress(&open.window, Qt::Key_W);
                if (QTest::qWaitFor([&] { return speed() > 0.1; }, 3000))
                    return true;
                QTest::keyRelease(&open.window, Qt::Key_W);
            }
            return false;
        };
        QVERIFY2(drives(), qPrintable(open.drive.problem()));
        QVERIFY(somebody.callAndWait("source.open", QJsonObject{{"recording", "once"}, {"loop", true}}).ok());
        QTRY_VERIFY_WITH_TIMEOUT(label("replayBanner")->isVisible(), 1000);
        TRY_CONTAINS(label("replayBanner")->text(), "velodynelogger replays");
        QTRY_COMPARE(speed(), 0.0); // the drive that was under way has ended
        QTest::keyRelease(&open.window, Qt::Key_W);
        QTest::keyPress(&open.window, Qt::Key_W);
        QTest::qWait(300);
        QCOMPARE(speed(), 0.0);
        TRY_CONTAINS(label("problem")->text(), "A replay is shown");
        QTest::keyRelease(&open.window, Qt::Key_W);
        OpenWindow::click(&open.window, "driveBlindly");
        QTRY_VERIFY(!open.drive.mustLetGo());
        QVERIFY2(drives(), qPrintable(open.drive.problem()));
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

    /// One logger is frozen: the other ends at once, this one when it can be spoken to again.
    void aStopIsSentUntilItIsAnswered() {
        RobotProcesses robot;
        robot.start("velodynelogger", {QString("source.port=%1").arg(reservePort()), "source.position_port=0",
                                       "record.folder=" + robot.path("recordings")});
        robot.start("seriallogger", {"record.folder=" + robot.path("recordings")});
        Fleet fleet;
        robot.connectTo(fleet);
        open(fleet, {"velodynelogger", "seriallogger"});
        ConnectedClient lidar(asOwner(QString("127.0.0.1:%1").arg(robot.port("velodynelogger"))));
        ConnectedClient serial(asOwner(QString("127.0.0.1:%1").arg(robot.port("seriallogger"))));
        const auto records = [](Client &client) {
            return client.callAndWait("record.status")->toObject()["recording"].toBool();
        };
        click("record");
        QTRY_COMPARE(message(), QString("Recording run1."));
        QTRY_COMPARE(button("record"), QString("S&top"));
        QVERIFY(records(lidar) && records(serial));
        robot.signal("seriallogger", SIGSTOP);
        click("record"); // before anybody knows that it is frozen
        QTRY_VERIFY_WITH_TIMEOUT(!records(lidar), 2000);
        TRY_STARTS(message(), "seriallogger does not answer, and may go on recording.");
        QTest::qWait(6000); // longer than calls are usually waited for
        VERIFY_STARTS(message(), "seriallogger does not answer, and may go on recording.");
        robot.signal("seriallogger", SIGCONT);
        QTRY_VERIFY_WITH_TIMEOUT(!records(serial), 10000);
        QTRY_COMPARE(message(), QString("Stopped, nothing missing."));
        QTRY_COMPARE(button("record"), QString("Re&cord"));
        QTRY_COMPARE(find<QTreeWidget>("sessions")->topLevelItemCount(), 1);
    }

    void aLoggerThatDiesIsTold() {
        RobotProcesses robot;
        const QStringList settings{"record.folder=" + robot.path("recordings")};
        robot.start("velodynelogger", settings + QStringList{QString("source.port=%1").arg(reservePort()),
                                                             "source.position_port=0"});
        robot.start("seriallogger", settings);
        Fleet fleet;
        robot.connectTo(fleet);
        open(fleet, {"velodynelogger", "seriallogger"});
        auto *const lost = find<QLabel>("lost");
        click("record");
        QTRY_COMPARE(button("record"), QString("S&top"));
        QVERIFY(!lost->isVisible());
        robot.kill("seriallogger");
        QTRY_VERIFY(lost->isVisible());
        QCOMPARE(lost->text(), QString("seriallogger was recording run1 and is gone."));
        QVERIFY(lost->palette().color(QPalette::WindowText) != panel_->palette().color(QPalette::WindowText));
        QCOMPARE(button("record"), QString("S&top")); // the other goes on
        robot.kill("velodynelogger");
        TRY_CONTAINS(lost->text(), "velodynelogger was recording run1 and is gone.");
        QCOMPARE(text("amount"), QString("No logger is connected."));
        QVERIFY2(!find<QLabel>("message")->isVisible(), qPrintable(message())); // "Recording run1." of nobody
        robot.start("seriallogger", settings);
        QTRY_VERIFY_WITH_TIMEOUT(lost->text().contains("seriallogger was gone while it recorded run1"),
                                 20000);
        QTRY_VERIFY(find<QPushButton>("record")->isEnabled() && !button("record").contains("top"));
        QTRY_COMPARE(find<QLineEdit>("name")->text(), QString("run2"));
        QTRY_COMPARE(message(), QString("The recording run1 has ended.\nseriallogger: it was cut off"));
        click("record"); // who begins anew has seen it
        QTRY_VERIFY(!lost->isVisible());
    }

    void theNextFreeNameIsProposed_data() {
        const Rows<QString, QStringList, QString> row("name", "taken", "next");
        row("free", "run1", {"run2"}, "run1");
        row("next", "run1", {"run1"}, "run2");
        row("gap", "run1", {"run1", "run2", "run4"}, "run3");
        row("ten", "run9", {"run9"}, "run10");
        row("zeros", "run007", {"run007"}, "run008");
        row("no number", "hall", {"hall", "hall2"}, "hall3");
        row("a number", "1", {"1"}, "2");
        row("none", "", {"run1"}, "");
        row("long number", "run99999999999999999999", {"run99999999999999999999"},
            "run999999999999991000000");
    }

    void theNextFreeNameIsProposed() {
        FETCH(QString, name, QStringList, taken);
        SessionList list;
        for (const QString &one : taken)
            list.sessions.push_back({one, one, 0, 0, {}});
        QTEST(nextFreeName(name, list), "next");
    }

    /// By what they are, not by their text; whatever a logger says.
    void recordingsAreSortedByTheHeader() {
        SessionList list;
        const auto add = [&list](const QString &name, double start, double end, double bytes) {
            list.sessions.push_back({name, name, start, end, {}});
            list.sessions.back().parts.push_back(
                {SessionMember(), {{"bytes", bytes}, {"ended", "stopped"}, {"complete", true}}});
        };
        const double today = QDateTime::currentMSecsSinceEpoch() * 1e-3;
        add("run10", today, today + 100, 900);
        add("run2", today - 90000, today - 89000, 6.3 * 1024 * 1024 * 1024);
        add("run1", 1e300, -1e300, std::nan(""));
        add("run3", std::nan(""), std::nan(""), 2048);
        SessionTable table;
        table.tell(list);
        table.resize(500, 200);
        table.show();
        const auto names = [&table] {
            QStringList shown;
            for (int i = 0; i < table.topLevelItemCount(); ++i)
                shown.append(table.topLevelItem(i)->text(0));
            return shown;
        };
        QCOMPARE(table.chosen()->name, QString("run10")); // the first of the list is the latest
        QCOMPARE(names().mid(0, 3), QStringList({"run1", "run10", "run2"}));
        const auto clickHeader = [&table](int column) {
            QHeaderView *const header = table.header();
            QTest::mouseClick(header->viewport(), Qt::LeftButton, {},
                              {header->sectionViewportPosition(column) + 20, header->height() / 2});
        };
        clickHeader(0);
        if (names().first() != "run1")
            clickHeader(0);
        QCOMPARE(names(), QStringList({"run1", "run2", "run3", "run10"}));
        clickHeader(3);
        clickHeader(3);
        const QTreeWidgetItem *const largest =
            table.topLevelItem(table.topLevelItemCount() - 1)->text(0) == "run2"
                ? table.topLevelItem(table.topLevelItemCount() - 1)
                : table.topLevelItem(0);
        QCOMPARE(largest->text(0), QString("run2"));
        QCOMPARE(largest->text(2), QString("16 min 40 s"));
        QCOMPARE(largest->text(3), QString("6.3 GiB"));
        QCOMPARE(table.chosen()->name, QString("run10"));
        list.sessions.erase(list.sessions.begin());
        table.tell(list);
        QCOMPARE(table.chosen()->name, QString("run2"));
    }

    /// A packet that the computer dropped is also missing: the counts are of several kinds and have no sum.
    void lossesAreToldByTheirNames() {
        FakeLoggers robot;
        FakeLogger &logger = robot.add("lidar");
        Fleet fleet;
        QVERIFY(fleet.add(logger.address().section("//", -1)).ok());
        panel_ = std::make_unique<RecordPanel>(fleet);
        panel_->show();
        QTRY_VERIFY(find<QPushButton>("record")->isEnabled());
        click("record");
        RecordingState state;
        state.losses = {{"missing", 3}, {"kernel", 3}, {"too_long", 0}, {"disk_bytes", 7}};
        logger.writer.setState(state);
        TRY_CONTAINS(text("amount"), "; lidar lost: disk bytes 7, kernel 3, missing 3");
        click("record");
        QTRY_VERIFY(!logger.recording.isActive());
    }

    void cleanup() { panel_.reset(); }

private:
    QString message() const { return text("message"); }
};
