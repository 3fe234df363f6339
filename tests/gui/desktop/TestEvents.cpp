#include "gui/desktop/panels/EventsPanel.h"
#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/FakeRobot.h"

using namespace hermes;
using Level = Event::Level;

/// What is told of, and for how long: the list alone, then in the window with real daemons.
class TestEvents : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void errorWaitsForAcknowledgement() {
        Events events;
        QSignalSpy alarms(&events, &Events::alarm);
        events.happened(Level::Error, "motorcontrol", "killed");
        events.happened(Level::Warning, "motorcontrol", "battery low");
        QCOMPARE(alarms.size(), 1);
        QCOMPARE(events.loudest()->text, QString("killed")); // before the later warning
        QCOMPARE(events.waiting(), 2);
        events.acknowledge(events.loudest()->id);
        QCOMPARE(events.loudest()->text, QString("battery low"));
        events.acknowledgeAll();
        QVERIFY(!events.loudest());
        QCOMPARE(int(events.all().size()), 2); // they stay in the list
        events.happened(Level::Info, "motorcontrol", "released");
        QVERIFY(!events.loudest()); // asks for nothing
    }

    void warningThatIsOverGoes() {
        Events events, errors;
        errors.goesOn("b", Level::Error, "lidar", "no packets");
        errors.ends("b");
        events.goesOn("a", Level::Warning, "lidar", "silent");
        QTest::qWait(500);
        QVERIFY(events.loudest()); // as long as it lasts
        events.ends("a");
        QVERIFY(events.loudest());
        QTRY_VERIFY_WITH_TIMEOUT(!events.loudest(), int(1000 * Events::warningStays_s) + 2000);
        QVERIFY(events.all().front().isOver && !events.all().front().isAcknowledged);
        QVERIFY(errors.loudest()); // an error waits
    }

    void whatComesAgainIsOneEvent() {
        Events events;
        QSignalSpy alarms(&events, &Events::alarm);
        for (int i = 0; i < 5; ++i)
            events.happened(Level::Warning, "serial", "a bad line");
        for (int i = 0; i < 5; ++i) {
            events.goesOn("key", Level::Warning, "lidar", QString("lost %1 packets").arg(i));
            events.ends("key");
        }
        QCOMPARE(int(events.all().size()), 2);
        QCOMPARE(events.all()[0].times, 5);
        QCOMPARE(events.all()[1].times, 5);
        QCOMPARE(events.all()[1].text, QString("lost 4 packets"));
        QCOMPARE(alarms.size(), 0);
        events.goesOn("on", Level::Error, "motors", "a");
        events.acknowledgeAll();
        events.goesOn("on", Level::Error, "motors", "b"); // other words for what is known
        QVERIFY(!events.loudest());
        events.ends("on");
        events.goesOn("on", Level::Error, "motors", "b"); // it was over and is there again
        QVERIFY(events.loudest());
        QCOMPARE(alarms.size(), 2);
    }

    void whatGoesOnComesFirst() {
        Events events;
        events.goesOn("a", Event::Level::Error, "anna", "does not answer");
        events.ends("a");
        events.goesOn("b", Event::Level::Error, "berta", "does not answer");
        events.ends("b");
        events.goesOn("a", Event::Level::Error, "anna", "does not answer"); // the first of the list once more
        QCOMPARE(events.loudest()->from, QString("anna"));
        QCOMPARE(events.loudest()->times, 2);
        events.ends("a");
        events.goesOn("a", Event::Level::Error, "anna", "no connection");
        QCOMPARE(events.loudest()->text, QString("no connection"));
        QCOMPARE(events.loudest()->times, 1);
        QCOMPARE(int(events.all().size()), 3);
        events.ends("a");
        events.goesOn("battery", Event::Level::Warning, "carla", "less than a minute");
        QCOMPARE(events.loudest()->from, QString("carla")); // no error that is over hides it
    }

    void worseHasToBeSeenAgain() {
        Events events;
        events.goesOn("battery", Level::Warning, "motors", "21 V");
        events.acknowledgeAll();
        events.goesOn("battery", Level::Error, "motors", "18 V");
        QVERIFY(events.loudest() && events.loudest()->level == Level::Error);
        QCOMPARE(int(events.all().size()), 1);
    }

    void errorsOutlastAFlood() {
        Events events;
        events.happened(Level::Error, "motors", "the one that matters");
        events.goesOn("held", Level::Error, "motors", "goes on");
        auto timer = runningTimer();
        for (int i = 0; i < 20000; ++i)
            events.happened(Level::Warning, "noise", QString::number(i));
        QVERIFY2(timer.elapsed() < 5000, saying(timer.elapsed()));
        QCOMPARE(events.all().size(), Events::most);
        QCOMPARE(events.forgotten(), quint64(20002 - Events::most));
        QCOMPARE(events.all().front().text, QString("the one that matters"));
        events.ends("held");
        QVERIFY(events.all()[1].isOver);
    }

    void keysAreForgottenWithTheirEvents() {
        Events events;
        for (int i = 0; i < 5000; ++i) {
            events.goesOn("key" + QString::number(i), Level::Warning, "noise", QString::number(i));
            events.ends("key" + QString::number(i));
        }
        events.goesOn("key0", Level::Warning, "noise", "again"); // its first event is gone
        QCOMPARE(events.all().back().text, QString("again"));
        QCOMPARE(events.all().back().times, 1);
    }

    void killedProcessIsAnError() {
        RobotProcesses robot;
        const QString entry =
            QString(R"([{"name":"one","program":"/bin/sleep","arguments":["600"],"autostart":true}])");
        robot.start("supervisor", {"processes=" + entry});
        OpenWindow window(robot);
        QVERIFY(window.show());
        DaemonLink *const supervisor = window.fleet.robot()->withMethod("process.list");
        qint64 pid = 0;
        const auto askPid = [&] {
            supervisor->call("process.list", {}, this, [&pid](const Result<QJsonValue> &list) {
                pid = list ? (*list)["processes"][0]["pid"].toInt() : 0;
            });
            return pid > 0;
        };
        QTRY_VERIFY_WITH_TIMEOUT(askPid(), 10000);
        QCOMPARE(::kill(pid_t(pid), SIGKILL), 0);
        QTRY_VERIFY2_WITH_TIMEOUT(textOf(window).contains("killed by signal 9 (SIGKILL)"),
                                  qPrintable(textOf(window)), 10000);
        QCOMPARE(backgroundOf(window), QString("#d0100c"));
        const QStringList rows = rowsOf(window);
        QVERIFY2(!rows.filter("error | supervisor | process: one: ended, killed by signal 9").isEmpty(),
                 qPrintable(rows.join('\n')));
        auto *const acknowledge = window.window.findChild<QPushButton *>("acknowledge");
        QVERIFY(acknowledge->isEnabled());
        const auto clickAndLook = [&] { // a click for each that waits
            QTest::mouseClick(acknowledge, Qt::LeftButton);
            return !acknowledge->isEnabled();
        };
        QTRY_VERIFY_WITH_TIMEOUT(clickAndLook(), 10000);
        QVERIFY(backgroundOf(window) != "#d0100c");
    }

    void whoStoppedIsTold() {
        FakeRobot robot;
        OpenWindow window(robot.address());
        QVERIFY(window.show());
        ConnectedClient other(robot.address());
        QVERIFY(other.callAndWait("motor.estop", QJsonObject{{"client", "anna on laptop7"}}).ok());
        QTRY_VERIFY2_WITH_TIMEOUT(textOf(window).contains("emergency stop by anna on laptop7"),
                                  qPrintable(textOf(window)), 10000);
        QVERIFY(releaseStop(other, {{"client", "anna on laptop7"}}));
        QTRY_VERIFY2_WITH_TIMEOUT(
            !rowsOf(window).filter("note | motorcontrol | stop: released by anna on laptop7").isEmpty(),
            qPrintable(rowsOf(window).join('\n')), 10000);
        QTRY_VERIFY2(!rowsOf(window)
                          .filter(QRegularExpression(
                              "^error \\| motorcontrol \\| stop: .*anna on laptop7.* \\| over$"))
                          .isEmpty(),
                     qPrintable(rowsOf(window).join('\n')));
    }

    void healthIsToldWhileItLasts() {
        FakeDaemon daemon({});
        OpenWindow window;
        QVERIFY(window.fleet.add(daemon.address()).ok());
        QVERIFY(window.show());
        QTRY_VERIFY(daemon.subscriptions("status") > 0);
        const auto status = [](const QByteArray &items) {
            return R"({"state":"running","health":[)" + items + "]}";
        };
        QTRY_VERIFY(window.fleet.robot()->withTopic("status"));
        auto timer = runningTimer();
        const auto isTold = [&] { // once the connection is old enough
            daemon.say("status", status(R"({"name":"disk","level":"warn","message":"nearly full"})"));
            return textOf(window).contains("disk: nearly full");
        };
        QTRY_VERIFY2_WITH_TIMEOUT(isTold(), qPrintable(textOf(window)), 15000);
        QVERIFY(timer.elapsed() > 2000);
        daemon.say("status", status(R"({"name":"disk","level":"ok","message":"fine"})"));
        QTRY_VERIFY2(!rowsOf(window).filter(QRegularExpression("disk: nearly full.* over$")).isEmpty(),
                     qPrintable(rowsOf(window).join('\n')));
    }

    // With the time at which it was, not that of the connection.
    void whatWasLoggedWhileTheLinkWasAwayWaits() {
        const double now = std::floor(QDateTime::currentMSecsSinceEpoch() / 1000.0);
        const auto record = [now](double ago, const char *text) {
            return QString(R"({"stamp":%1,"level":"error","source":"test","text":"%2"})")
                .arg(now - ago, 0, 'f', 3)
                .arg(text)
                .toUtf8();
        };
        const QByteArray before = record(3000, "before");
        Mischief mischief;
        mischief.results["log.tail"] = '[' + before + ']';
        mischief.topics["log"] = record(2500, "live");
        FakeDaemon daemon(mischief);
        OpenWindow window;
        QVERIFY(window.fleet.add(daemon.address()).ok());
        QVERIFY(window.show());
        QTRY_COMPARE(rowsOf(window).filter("test: before").size(), 1);
        QTRY_COMPARE(rowsOf(window).filter("test: live").size(), 1);
        daemon.setResult("log.tail",
                         '[' + before + ',' + record(2500, "live") + ',' + record(2000, "missed") + ']');
        daemon.dropAll();
        QTRY_COMPARE_WITH_TIMEOUT(rowsOf(window).filter("test: missed").size(), 1, 20000);
        QCOMPARE(rowsOf(window).filter("test: before").size(), 1);
        const auto *const model = window.window.findChild<QTreeView *>("events")->model();
        const QString time = QDateTime::fromMSecsSinceEpoch(qint64(1000 * (now - 2000))).toString("HH:mm:ss");
        bool isTimed = false;
        for (int row = 0; row < model->rowCount(); ++row)
            isTimed = isTimed || (model->index(row, 0).data().toString().contains(time) &&
                                  model->index(row, 3).data().toString().contains("missed"));
        QVERIFY2(isTimed, qPrintable(time));
    }

    void frozenDaemonIsAnError() {
        RobotProcesses robot;
        robot.start("simulator");
        OpenWindow window(robot);
        QVERIFY(window.show());
        const QString frozen = "error | simulator | It is connected, but does not answer | ";
        const auto *const line = window.window.findChild<QLabel *>("eventText");
        robot.signal("simulator", SIGSTOP);
        QTRY_VERIFY2_WITH_TIMEOUT(!rowsOf(window).filter(frozen + "goes on").isEmpty(),
                                  qPrintable(rowsOf(window).join('\n')), 10000);
        TRY_CONTAINS(line->text(), "simulator: It is connected, but does not");
        QVERIFY(line->styleSheet().contains("#d0100c"));
        robot.signal("simulator", SIGCONT);
        QTRY_VERIFY2_WITH_TIMEOUT(!rowsOf(window).filter(frozen + "over").isEmpty(),
                                  qPrintable(rowsOf(window).join('\n')), 10000);
        const QRegularExpression over("OVER after \\d+ s: simulator: It is connected");
        TRY_CONTAINS(line->text(), over);
        QVERIFY(!line->styleSheet().contains("#d0100c"));
        robot.kill("simulator");
        QTRY_VERIFY2_WITH_TIMEOUT(!rowsOf(window).filter("error | simulator | No connection").isEmpty(),
                                  qPrintable(rowsOf(window).join('\n')), 10000);
    }

    void hostileTextIsPlain() {
        FakeDaemon daemon({});
        OpenWindow window;
        QVERIFY(window.fleet.add(daemon.address()).ok());
        QVERIFY(window.show());
        QTRY_VERIFY(daemon.subscriptions("log") > 0);
        const QByteArray text = "<b>bold</b>\\u202e\\n" + QByteArray(10000, 'x');
        daemon.say(
            "log",
            QByteArray(R"({"stamp":1e300,"level":"error","source":"s","text":"%1"})").replace("%1", text));
        TRY_CONTAINS(textOf(window), "<b>bold</b>");
        QVERIFY(textOf(window).size() < 500);
        QCOMPARE(window.window.findChild<QLabel *>("eventText")->textFormat(), Qt::PlainText);
        daemon.say("log", R"({"level":7})");
        QTRY_VERIFY(!rowsOf(window).filter("warning").isEmpty());
    }

    void soundsCanBeSwitchedOff() {
        QTemporaryDir folder;
        const QString file = folder.filePath("gui.json");
        Fleet fleet;
        DriveControl drive(fleet);
        {
            MainWindow window(fleet, drive, file);
            window.show();
            window.findChild<QDockWidget *>("events")->raise();
            auto *const sounds = window.findChild<QCheckBox *>("sounds");
            QTRY_VERIFY(sounds->isVisible());
            QVERIFY(sounds->isChecked());
            QTest::mouseClick(sounds, Qt::LeftButton, {}, QPoint(8, sounds->height() / 2));
            QVERIFY(!sounds->isChecked());
            window.close();
        }
        MainWindow window(fleet, drive, file);
        QVERIFY(!window.findChild<QCheckBox *>("sounds")->isChecked());
    }

private:
    static QString textOf(const OpenWindow &window) {
        return window.window.findChild<QLabel *>("eventText")->text();
    }
    static QString backgroundOf(const OpenWindow &window) {
        return window.window.findChild<QLabel *>("eventText")->palette().color(QPalette::Window).name();
    }
    /// The rows of the list, column by column.
    static QStringList rowsOf(OpenWindow &window) {
        auto *const model = window.panel<EventsPanel>("events")->findChild<QTreeView *>("events")->model();
        QStringList rows;
        for (int row = 0; row < model->rowCount(); ++row) {
            QStringList cells;
            for (int column = 1; column < model->columnCount(); ++column)
                cells.append(model->index(row, column).data().toString());
            rows.append(cells.join(" | "));
        }
        return rows;
    }
};
