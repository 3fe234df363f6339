// How fast hermes-motorcontrol stops the wheels when its client's computer is cut off from the network.
#include "FarNetwork.h"
#include "StopTrials.h"

class TestMotorCutOff : public QObject, StopTrials {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        const QString missing = network_.make();
        if (!missing.isEmpty())
            QSKIP(qPrintable(missing));
        host_ = FarNetwork::nearHost;
    }

    void cleanup() { tearDown(); }

    // The client goes on, into a network that is not there; its connection stays open.
    void cutOffClientIsStopped() {
        setUp();
        if (QTest::currentTestFailed())
            return;
        std::vector<double> times;
        for (int trial = 0; int(times.size()) < trials(); ++trial) {
            startDriver(network_.enter());
            QTest::qWait(trial * 7 % 50); // not in step with its commands
            beginTrial();
            QCOMPARE(network_.setLink(false), QString());
            const double cut = RoboClawRig::now();
            awaitStop();
            if (QTest::currentTestFailed())
                return;
            const double last = lastCommand(cut);
            QVERIFY(last > cut - 1);
            if (endTrial())
                times.push_back(rig_->zeroSince() - last);
            QCOMPARE(driver_->state(), QProcess::Running); // it was not refused
            driver_->kill();
            QVERIFY(driver_->waitForFinished());
            QCOMPARE(network_.setLink(true), QString());
        }
        report("cut off", times, 0.35, 1);
        reportStand();
    }

private:
    FarNetwork network_;
};
