#include "common/client/DaemonAddress.h"
#include "tests/gui/desktop/RecordPanelFixture.h"
#include "tests/gui/desktop/RobotProcesses.h"
#include "tests/gui/desktop/TcpLink.h"

using namespace hermes;

/// A recording ends while another robot is chosen, or by others than the window.
class TestRecordingEnd : public QObject, RecordPanelFixture {
    Q_OBJECT
private Q_SLOTS:
    void aStopGoesOnWhileAnotherRobotIsChosen() {
        TwoRobots robots;
        stopAndChooseOther(robots);
        if (QTest::currentTestFailed())
            return;
        QTRY_COMPARE_WITH_TIMEOUT(
            text("lost"), QString("red: seriallogger does not answer, and may go on recording."), 15000);
        click("record"); // of the other robot
        QTRY_COMPARE(text("message"), QString("Recording run1."));
        robots.real.signal("seriallogger", SIGCONT);
        QTRY_VERIFY_WITH_TIMEOUT(!robots.serialRecords(), 15000);
        QTRY_VERIFY_WITH_TIMEOUT(text("message") != "Recording run1.", 15000);
        QCOMPARE(text("message"), QString("red: Stopped, nothing missing."));
        QVERIFY(robots.other.isRecording());
        QTRY_VERIFY(!find<QLabel>("lost")->isVisible());
        robots.fleet.choose(robots.fleet.robotAt("127.0.0.1"));
        QTRY_VERIFY(!length(0).isEmpty());
        QVERIFY(length(0) != "goes on");
        QVERIFY(find<QTreeWidget>("sessions")->topLevelItem(0)->toolTip(0).contains("seriallogger"));
    }

    void aStopOfARobotThatIsRemoved() {
        TwoRobots robots;
        stopAndChooseOther(robots);
        if (QTest::currentTestFailed())
            return;
        QVERIFY(robots.fleet.remove(robots.fleet.robotAt("127.0.0.1")).ok());
        QTRY_COMPARE(text("message"),
                     QString("red was removed before its recording had ended: it may still record."));
        robots.real.signal("seriallogger", SIGCONT);
        click("record"); // of the other robot
        QTRY_COMPARE(text("message"), QString("Recording run1."));
        QTRY_VERIFY_WITH_TIMEOUT(recordsForSeconds("run1"), 15000);
        QCOMPARE(text("message"), QString("Recording run1.")); // it was said once
    }

    void aLoggerThatWasAwayIsStoppedToo_data() {
        falseAndTrue("isLater", "the same recording",
                     "a later one"); // others have begun another recording meanwhile, which goes on
    }

    /// Its link was gone as Stop was pressed.
    void aLoggerThatWasAwayIsStoppedToo() {
        QFETCH(bool, isLater);
        FakeLoggers robot;
        FakeLogger &here = robot.add("here"), &away = robot.add("away");
        Fleet fleet;
        open(fleet, robot);
        click("record");
        QTRY_COMPARE(button("record"), QString("S&top"));
        QTRY_VERIFY(here.recording.isActive() && away.recording.isActive());
        DaemonLink *const link = fleet.robot()->withName("away");
        link->client().close();
        QTRY_COMPARE(text("lost"), QString("away was recording run1 and is gone."));
        click("record");
        QTRY_VERIFY(!here.recording.isActive());
        TRY_CONTAINS(text("message"), "away: it took part, but does not answer");
        QVERIFY(away.recording.isActive());
        if (isLater) {
            QVERIFY(robot.clients.back()->callAndWait("record.stop").ok());
            QVERIFY(robot.clients.back()->callAndWait("record.start", QJsonObject{{"name", "later"}}).ok());
        }
        QVERIFY(link->client().connectTo(away.address()).ok());
        if (isLater) {
            QTRY_VERIFY_WITH_TIMEOUT(recordsForSeconds("later"), 30000);
            QVERIFY(away.recording.isActive());
            click("record");
        }
        QTRY_VERIFY_WITH_TIMEOUT(!away.recording.isActive(), 15000);
        QTRY_COMPARE(text("message"), QString("Stopped, nothing missing."));
        QVERIFY(isLater || !find<QLabel>("lost")->isVisible()); // it had gone on
    }

    /// It has begun, and nobody knows.
    void aStartWhoseLinkBreaksIsTakenBack() {
        RobotProcesses robot;
        robot.start("seriallogger", {"record.folder=" + robot.path("recordings")});
        Fleet fleet;
        ConnectedClient client(asOwner(QString("127.0.0.1:%1").arg(robot.port("seriallogger"))));
        TcpLink link(robot.port("seriallogger"));
        link.cutAfter("record.start");
        QVERIFY(fleet.add(QString("127.0.0.1:%1").arg(link.port())).ok());
        open(fleet, {"seriallogger"});
        int begun = 0;
        client.subscribe("log", {}, [&begun](const TopicUpdate &update) {
            begun += update.data.toJson()["text"].toString().startsWith("recording to");
        });
        click("record");
        QTRY_VERIFY2_WITH_TIMEOUT(text("message").contains("is not recorded"), qPrintable(text("message")),
                                  20000);
        QVERIFY(link.wasCut());
        QTRY_VERIFY(begun == 1);
        QTRY_VERIFY_WITH_TIMEOUT(!client.callAndWait("record.status")->toObject()["recording"].toBool(),
                                 15000);
        QTest::qWait(2500); // why it failed stays
        VERIFY_CONTAINS(text("message"), "is not recorded");
    }

    void anotherClientEndsIt() {
        FakeLoggers robot;
        robot.add("one");
        robot.add("two");
        Fleet fleet;
        open(fleet, robot);
        for (const auto &client : robot.clients)
            QVERIFY(
                client->callAndWait("record.start", QJsonObject{{"name", "run1"}, {"session", "x"}}).ok());
        QTRY_COMPARE(length(0), QString("goes on"));
        QVERIFY(robot.clients.front()->callAndWait("record.stop").ok());
        QTRY_COMPARE(text("message"), QString("one no longer records run1 (not from here)."));
        QCOMPARE(length(0), QString("goes on"));
        QVERIFY(robot.clients.back()->callAndWait("record.stop").ok());
        QTRY_COMPARE(text("message"), QString("The recording run1 has ended (not from here)."));
        QVERIFY(length(0) != "goes on" && !length(0).isEmpty());
        QCOMPARE(button("record"), QString("Re&cord"));
        QCOMPARE(find<QLineEdit>("name")->text(), QString("run2"));
    }

    void aFullDiskEndsIt() {
        FakeLoggers robot;
        FakeLogger &logger = robot.add("lidar");
        Fleet fleet;
        open(fleet, robot);
        click("record");
        QTRY_COMPARE(length(0), QString("goes on"));
        QTRY_COMPARE(button("record"), QString("S&top"));
        const QJsonObject full{{"free_floor_bytes", 1e15}, {"free_warn_bytes", 1e15}};
        QVERIFY(logger.settings().set({{"record", full}}).ok());
        QTRY_VERIFY(!logger.recording.isActive());
        QTRY_COMPARE(text("message"), QString("The recording run1 has ended.\nlidar: the disk was full"));
        QVERIFY(length(0) != "goes on" && !length(0).isEmpty());
        const auto colour = [this](const char *label) {
            return find<QLabel>(label)->palette().color(QPalette::WindowText);
        };
        QCOMPARE(colour("message"), colour("lost"));
    }

    void aFaultEndsIt() {
        FakeLoggers robot;
        FakeLogger &logger = robot.add("lidar");
        Fleet fleet;
        open(fleet, robot);
        click("record");
        QTRY_COMPARE(button("record"), QString("S&top"));
        RecordingState state;
        state.error = Error(ErrorCode::InputOutput, "the disk was pulled out");
        logger.writer.setState(state);
        QTRY_VERIFY2(text("message").startsWith("The recording run1 has ended.\nlidar: ") &&
                         text("message").contains("the disk was pulled out"),
                     qPrintable(text("message")));
    }

    /// In a dock that is not high the list gives way.
    void whatIsToldIsInView() {
        FakeLoggers robot;
        Fleet fleet;
        robot.add("lidar");
        open(fleet, robot);
        QScrollArea area; // as docks have it
        area.setWidgetResizable(true);
        area.setWidget(panel_.release());
        const auto find = [&area](const char *name) { return area.findChild<QWidget *>(name); };
        area.resize(300, area.widget()->minimumSizeHint().height() + 100);
        area.show();
        QVERIFY(robot.clients.front()->callAndWait("record.start", QJsonObject{{"name", "run1"}}).ok());
        const auto *const record = area.findChild<QPushButton *>("record");
        QTRY_COMPARE(record->text(), QString("S&top"));
        QVERIFY(robot.clients.front()->callAndWait("record.stop").ok());
        const auto *const message = area.findChild<QLabel *>("message");
        TRY_CONTAINS(message->text(), "not from here");
        const auto isInView = [&](const QWidget *widget) {
            return area.viewport()->rect().contains(
                QRect(widget->mapTo(area.viewport(), QPoint()), widget->size()));
        };
        QTRY_VERIFY(message->isVisible() && isInView(message) && isInView(find("live")));
    }

    void cleanup() { panel_.reset(); }

private:
    /// A robot with a serial logger that may be frozen, the chosen one, beside one with a logger in the
    /// process of the test.
    struct TwoRobots {
        TwoRobots() {
            real.start("velodynelogger",
                       {QString("source.port=%1").arg(reservePort()), "source.position_port=0",
                        "record.folder=" + real.path("recordings")});
            real.start("seriallogger", {"record.folder=" + real.path("recordings")});
            real.connectTo(fleet);
            other.add("other");
            QVERIFY(fleet.add(address()).ok());
            QTRY_VERIFY(fleet.daemonAt(address()) && fleet.robotOf(fleet.daemonAt(address())));
            fleet.place(fleet.daemonAt(address()), nullptr);
            fleet.rename(*fleet.robotAt("127.0.0.1"), "red");
            fleet.choose(fleet.robotAt("127.0.0.1"));
            for (const char *const name : {"velodynelogger", "seriallogger"}) {
                clients.push_back(
                    std::make_unique<ConnectedClient>(asOwner(QString("127.0.0.1:%1").arg(real.port(name)))));
            }
        }
        QString address() const { return other.loggers.front()->address().section("//", -1); }
        void chooseOther() { fleet.choose(fleet.robotOf(fleet.daemonAt(address()))); }
        static bool records(Client &client) {
            const Result<QJsonValue> status = client.callAndWait("record.status");
            return status && (*status)["recording"].toBool();
        }
        bool lidarRecords() { return records(*clients.at(0)); }
        bool serialRecords() { return records(*clients.at(1)); }

        RobotProcesses real;
        FakeLoggers other;
        Fleet fleet;
        std::vector<std::unique_ptr<Client>> clients;
    };

    /// Stop is pressed while the serial logger is frozen, and another robot is chosen.
    void stopAndChooseOther(TwoRobots &robots) {
        open(robots.fleet, {"velodynelogger", "seriallogger"});
        if (QTest::currentTestFailed())
            return;
        click("record");
        QTRY_COMPARE(button("record"), QString("S&top"));
        QTRY_VERIFY(robots.lidarRecords() && robots.serialRecords());
        robots.real.signal("seriallogger", SIGSTOP);
        click("record");
        robots.chooseOther();
        QTRY_COMPARE(text("amount"), QString("Records with other."));
        QTRY_VERIFY(!robots.lidarRecords());
    }
    QString length(int row) const {
        const QTreeWidgetItem *const item = find<QTreeWidget>("sessions")->topLevelItem(row);
        return item ? item->text(2) : QString();
    }
    /// So that it has asked all loggers several times.
    bool recordsForSeconds(const QString &name) const {
        return QRegularExpression('^' + name + ": ([4-9]|\\d\\d) s").match(text("amount")).hasMatch();
    }
};
