#include "common/client/DaemonAddress.h"
#include "gui/desktop/panels/SetupPanel.h"
#include "gui/setup/WheelSettings.h"
#include "gui/setup/WheelTurn.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// The first contact through the window: a supervisor, and a simulated robot at the far end of a real line.
class TestSetupPanel : public QObject {
    Q_OBJECT
private Q_SLOTS:
    // Where it is permitted: controllers that a busy machine holds up are told not to answer.
    void initTestCase() { ::setpriority(PRIO_PROCESS, 0, -15); }

    void init() {
        robot_ = std::make_unique<RobotProcesses>();
        folder_ = robot_->path("etc");
        motors_ = robot_->path("motors");
    }

    void cleanup() {
        window_.reset();
        robot_.reset();
    }

    void findsProposesWritesAndUndoes() {
        open(false);
        QVERIFY(!find<QPushButton>("applySetup")->isEnabled());
        search(false);
        QCOMPARE(what(motors_), QString("not asked"));
        QVERIFY(!find<QPushButton>("applySetup")->isEnabled());
        search(true);
        QTRY_COMPARE(what(motors_), QString("motors"));
        for (const char *tick : {"ask", "release"}) // they are said for one search
            QVERIFY(!find<QCheckBox>(tick)->isChecked());
        QTRY_COMPARE(change("controllers.2.address"), folder_ + "/motorcontrol.json  129");
        QVERIFY(file("motorcontrol").toObject().isEmpty());
        OpenWindow::click(panel(), "applySetup");
        QTRY_VERIFY2_WITH_TIMEOUT(message().startsWith("Written: "), qPrintable(message()), 30000);
        QCOMPARE(file("motorcontrol")["controllers"]["2"]["address"].toInt(), 129);
        QVERIFY(!find<QPushButton>("applySetup")->isEnabled());
        OpenWindow::click(panel(), "undoSetup");
        QTRY_VERIFY(file("motorcontrol").toObject().isEmpty());
        TRY_STARTS(message(), "Written: ");
        OpenWindow::click(panel(), "undoSetup");
        TRY_CONTAINS(message(), "nothing to undo");
    }

    void sampleIsWritten() {
        open(false);
        auto *const samples = find<QComboBox>("samples");
        const int row = samples->findData("mecanum");
        QVERIFY(row > 0);
        samples->setFocus();
        while (samples->currentIndex() != row)
            QTest::keyClick(samples, Qt::Key_Down);
        OpenWindow::click(panel(), "applySetup");
        QTRY_VERIFY2_WITH_TIMEOUT(message().startsWith("Written: "), qPrintable(message()), 30000);
        QVERIFY(QFile::exists(folder_ + "/scanmatcher.json"));
        QCOMPARE(samples->currentIndex(), 0);
    }

    void refusalIsTold() {
        open(false);
        search(true);
        QTRY_VERIFY(find<QPushButton>("applySetup")->isEnabled());
        QVERIFY(QDir(folder_).removeRecursively());
        OpenWindow::click(panel(), "applySetup");
        QTRY_VERIFY2_WITH_TIMEOUT(message().contains("motorcontrol.json"), qPrintable(message()), 30000);
        QVERIFY(!message().startsWith("Written"));
        QVERIFY(find<QPushButton>("applySetup")->isEnabled()); // to be tried again
    }

    void withoutSupervisorNothingIsPossible() {
        open(false);
        robot_->kill("supervisor");
        QTRY_VERIFY(!find<QPushButton>("findDevices")->isEnabled());
        QVERIFY(find<QPushButton>("findDevices")->toolTip().contains("supervisor"));
        QVERIFY(!find<QPushButton>("undoSetup")->isEnabled());
    }

    void wheelsTurnOnlyWhenLifted() {
        open(true);
        auto *const test = find<QPushButton>("testWheels");
        QVERIFY(!test->isEnabled());
        lift();
        awaitTurning();
        QVERIFY(ask("motorcontrol", "control.state")["held"].toBool());
        OpenWindow::click(panel(), "lifted"); // it is set down
        QTRY_VERIFY(areStanding());
        QTRY_VERIFY(!ask("motorcontrol", "control.state")["held"].toBool());
        VERIFY_CONTAINS(wheelMessage(), "not lifted");
        QVERIFY(!test->isEnabled());
    }

    void omniWheelsAreNotAskedFor() {
        open(true);
        ask("motorcontrol", "settings.set",
            {{"values", QJsonObject{{"frame", QJsonObject{{"layout", "omni4"}}}}}});
        lift();
        TRY_CONTAINS(wheelMessage(), "frame.layout is omni4");
        QVERIFY(areStanding());
        QVERIFY(!ask("motorcontrol", "control.state")["held"].toBool());
    }

    void wheelsTurnNoSlowerThanTheyCan() {
        QJsonObject settings{{"wheels", QJsonObject()}};
        const QJsonObject state{{"wheels", QJsonObject{{"rear_left", QJsonObject()}}}};
        QCOMPARE(WheelPlan::from(settings, state)->speed, 1.0);
        QCOMPARE(WheelPlan::from(settings, state)->wheels, QStringList("rear_left"));
        settings["faults"] = QJsonObject{{"encoder_commanded_rad_s", 1.7}};
        QCOMPARE(WheelPlan::from(settings, state)->speed, 1.7);
    }

    void testOfWheelsGivesSettings() {
        open(true);
        lift();
        // Told: front left, front right, rear left, rear right. Seen: the first backward, the others as told.
        for (const char *const wheel : {"front left", "front right", "rear left", "rear right"}) {
            auto *const seen = find<QComboBox>("seen");
            QTRY_VERIFY2_WITH_TIMEOUT(seen->isEnabled() && seen->currentText().startsWith(wheel),
                                      qPrintable(wheelMessage()), 15000);
            QVERIFY2(areStanding(), wheel);
            QVERIFY2(QRegExp(".*tells (0\\.[89]|1\\.[01])\\d rad/s.*").exactMatch(wheelMessage()),
                     qPrintable(wheelMessage()));
            if (wheel == QString("front left"))
                seen->setCurrentIndex(1);
            OpenWindow::click(panel(), "nextWheel");
        }
        QTRY_COMPARE(change("wheels.front_left.reversed"), folder_ + "/motorcontrol.json false true");
        QVERIFY(!ask("motorcontrol", "control.state")["held"].toBool());
        QVERIFY(!find<QPushButton>("testWheels")->isEnabled()); // lifted was said of one test
        OpenWindow::click(panel(), "applySetup");
        QTRY_COMPARE_WITH_TIMEOUT(file("motorcontrol")["wheels"]["front_left"]["reversed"].toBool(), true,
                                  30000);
    }

    void stopEndsTheTestOfWheels() {
        open(true);
        lift();
        awaitTurning();
        QTest::keyClick(panel(), Qt::Key_Space);
        QTRY_VERIFY(areStanding());
        TRY_STARTS(wheelMessage(), "The test of the wheels has ended");
        QVERIFY2(!wheelMessage().contains("swap the wires"), qPrintable(wheelMessage())); // of an encoder
        QVERIFY(ask("motorcontrol", "motor.state")["estop"].toBool());
        QVERIFY(!find<QCheckBox>("lifted")->isChecked());
    }

    void outOfSightNoWheelTurns_data() {
        falseAndTrue("isClosed", "another tab is over it", "its dock is closed");
    }

    void outOfSightNoWheelTurns() {
        QFETCH(bool, isClosed);
        open(true);
        lift();
        awaitTurning();
        const auto *const lifted = find<QCheckBox>("lifted");
        if (isClosed)
            window_->window.findChild<QDockWidget *>("setup")->hide();
        else
            window_->window.findChild<QDockWidget *>("settings")->raise();
        QTRY_VERIFY(!lifted->isChecked());
        QTRY_VERIFY(areStanding());
        VERIFY_CONTAINS(wheelMessage(), "not in sight");
    }

    /// While the control is asked for.
    void givenUpEarlyLeavesTheControl() {
        open(true);
        ConnectedClient motors(QString("127.0.0.1:%1").arg(robot_->port("motorcontrol")));
        WheelTurn turn(motors, "test", Client::defaultTimeout);
        bool isOver = false;
        Result<double> measured = 0.0;
        turn.begin("front_left", 1, [&](const Result<double> &result) {
            isOver = true;
            measured = result;
        });
        QTimer each; // time that the event loop turns
        connect(&each, &QTimer::timeout, &turn, [&] {
            if (turn.isAcquiring())
                turn.giveUp();
        });
        each.start(0);
        QTRY_VERIFY(isOver);
        QVERIFY(!measured);
        QVERIFY(!ask("motorcontrol", "control.state")["held"].toBool());
    }

private:
    void open(bool withMotors) {
        if (withMotors)
            robot_->startMotors();
        else
            robot_->start("simulator",
                          {"world=" + qEnvironmentVariable("HERMES_SOURCE") + "/deploy/worlds/pillars.json",
                           "motors.link=" + motors_});
        robot_->startSupervisor({motors_}, reservePort());
        window_ = std::make_unique<OpenWindow>(*robot_);
        QVERIFY(window_->show());
        window_->window.resize(1280, 900);
        QTRY_COMPARE_WITH_TIMEOUT(find<QComboBox>("samples")->count(), 5, 10000);
        if (withMotors)
            QTRY_VERIFY_WITH_TIMEOUT(ask("motorcontrol", "motor.state")["ready"].toBool(), 10000);
    }

    SetupPanel *panel() const { return window_->panel<SetupPanel>("setup"); }
    template <typename T>
    T *find(const char *name) const {
        return panel()->findChild<T *>(name);
    }
    /// Of the panel itself, not of its test of the wheels.
    QString message() const {
        return panel()->findChild<QLabel *>("message", Qt::FindDirectChildrenOnly)->text();
    }
    QString wheelMessage() const {
        return find<QCheckBox>("lifted")->parent()->findChild<QLabel *>("message")->text();
    }
    QString what(const QString &where) const {
        const auto rows = find<QTreeWidget>("found")->findItems(where, Qt::MatchExactly, 1);
        return rows.isEmpty() ? QString() : rows.front()->text(0);
    }
    /// A row of the table of changes, as text.
    QString change(const QString &path) const {
        const auto rows =
            find<QTreeWidget>("changes")->findItems(path, Qt::MatchExactly | Qt::MatchRecursive);
        return rows.size() != 1
                   ? QString("%1 rows").arg(rows.size())
                   : rows[0]->parent()->text(0) + ' ' + rows[0]->text(1) + ' ' + rows[0]->text(2);
    }
    QJsonValue file(const QString &name) const {
        return QJsonDocument::fromJson(contentOf(folder_ + '/' + name + ".json")).object();
    }
    QJsonValue ask(const QString &daemon, const QString &method, const QJsonObject &params = {}) {
        Client client;
        client.connectTo(asOwner(QString("127.0.0.1:%1").arg(robot_->port(daemon))));
        const auto answer =
            client.waitConnected() ? client.callAndWait(method, params) : Result<QJsonValue>(QJsonValue());
        return answer ? *answer : QJsonValue();
    }
    QJsonArray wheelSpeeds() { return ask("simulator", "sim.state")["motors"]["wheels_rps"].toArray(); }
    bool areStanding() { return wheelSpeeds() == QJsonArray{0, 0, 0, 0}; }
    void search(bool ask) {
        OpenWindow::click(panel(), "release");
        if (ask)
            OpenWindow::click(panel(), "ask");
        OpenWindow::click(panel(), "findDevices");
        QTRY_VERIFY_WITH_TIMEOUT(find<QTreeWidget>("found")->topLevelItemCount() > 0, 30000);
        QTRY_VERIFY(find<QPushButton>("findDevices")->isEnabled());
    }
    void lift() {
        OpenWindow::click(panel(), "lifted");
        OpenWindow::click(panel(), "testWheels");
    }
    void awaitTurning() { QTRY_VERIFY_WITH_TIMEOUT(!areStanding(), 15000); }

    QString folder_, motors_;
    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> window_;
};
