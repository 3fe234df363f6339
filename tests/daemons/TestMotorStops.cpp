// How fast hermes-motorcontrol stops the wheels, as processes: a client or the daemon itself is killed or
// frozen. $HERMES_TRIALS trials of each, 3 where it is not set; the times are printed.
#include "StopTrials.h"
#include "tests/support/PatientClient.h"
#include "tests/support/ReleaseStop.h"

using namespace hermes;
using namespace hermes::simulator;

class TestMotorStops : public QObject, StopTrials {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    // From before the client writes the request to the last byte of the stop of both controllers.
    void emergencyStopReachesTheWire() {
        ConnectedClient client("127.0.0.1:" + port_);
        std::vector<double> times;
        for (int trial = 0; int(times.size()) < trials(); ++trial) {
            QTRY_VERIFY(client.callAndWait("control.acquire", QJsonObject{{"timeout_s", 10}}).ok());
            // Not in step with the cycle of the daemon.
            const double until = RoboClawRig::now() + 0.3 + 0.00137 * trial;
            while (RoboClawRig::now() < until || !isDriving()) {
                QVERIFY(client.callAndWait("motor.drive", QJsonObject{{"vx", 0.5}}).ok());
                QTest::qWait(5);
            }
            beginTrial();
            const double asked = RoboClawRig::now();
            QVERIFY(client.callAndWait("motor.estop", QJsonObject()).ok());
            awaitStop();
            if (QTest::currentTestFailed())
                return;
            if (endTrial())
                times.push_back(rig_->zeroSince() - asked);
            QVERIFY(releaseStop(client));
        }
        report("motor.estop to stop bytes", times, 0.020, 0.99);
        reportStand();
    }

    void signalToTheClient_data() {
        const Rows<int> row("signal");
        row("killed", SIGKILL);
        row("frozen", SIGSTOP);
    }

    void signalToTheClient() {
        QFETCH(int, signal);
        std::vector<double> times;
        for (int trial = 0; int(times.size()) < trials(); ++trial) {
            startDriver();
            QTest::qWait(trial * 7 % 50); // not in step with its commands
            beginTrial();
            QCOMPARE(::kill(pid_t(driver_->processId()), signal), 0);
            const double sent = RoboClawRig::now();
            awaitStop();
            if (QTest::currentTestFailed())
                return;
            const double last = lastCommand(sent);
            QVERIFY(last > sent - 1);
            if (endTrial())
                times.push_back(rig_->zeroSince() - last);
            driver_->kill();
            QVERIFY(driver_->state() == QProcess::NotRunning || driver_->waitForFinished());
        }
        report(QTest::currentDataTag(), times, 0.35, 1);
        reportStand();
    }

    void signalToTheDaemon_data() { signalToTheClient_data(); }

    // The controllers' own time-out of 0.2 s stops the wheels: they brake as hard as they can.
    void signalToTheDaemon() {
        QFETCH(int, signal);
        std::vector<double> times, standing;
        for (int trial = 0; int(times.size()) < trials(); ++trial) {
            startDriver();
            QTest::qWait(trial * 7 % 50);
            beginTrial();
            const double sent = RoboClawRig::now(), speed = rig_->rimSpeed();
            QCOMPARE(::kill(pid_t(daemon_->processId()), signal), 0);
            QTRY_VERIFY_WITH_TIMEOUT(RoboClawRig::now() - rig_->lastMoved() > 0.1, 2000);
            if (endTrial()) {
                times.push_back(rig_->lastDriven() - sent);
                standing.push_back(rig_->lastMoved() - rig_->lastDriven() - speed / deceleration);
            }
            cleanup();
            init();
            if (QTest::currentTestFailed())
                return;
        }
        reportRepeated();
        report(QTest::currentDataTag(), times, 0.3, 1);
        report("stand after the time of braking from the speed at the time-out", standing, 0.05, 1);
    }
};
