// The whole work of the motor control on a clock of its own: ten minutes of driving over a line on which one
// byte in 1,000 has a bit flipped, and the memory that $HERMES_TRAFFIC_HOURS of it need (half an hour where
// it is not set).
#include "VirtualDrive.h"
#include "tests/support/HeapGrowth.h"

using namespace hermes;
using namespace hermes::motorcontrol;
using namespace hermes::simulator;

class TestDriveEngine : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void tenMinutesOfFlippedBytes() {
        VirtualDrive drive(1e-3);
        drive.run(2, 0.001); // with the set-up, in which the line of one controller is silent for the other
        drive.longestPause = 0;
        drive.run(600, 0.001);
        QVERIFY(drive.flipped > 500);
        QCOMPARE(drive.foreign, 0);
        QCOMPARE(drive.refused, 0);
        QCOMPARE(drive.halts, 0);
        QVERIFY2(drive.longestPause < 0.25, saying(drive.longestPause));
        drive.rest(2);
        const Telemetry &told = drive.engine.report();
        qInfo("%llu of %llu bytes flipped, %llu failures counted, longest pause %.3f s, odometry off by %.1f "
              "mm",
              drive.flipped + 0ULL, drive.bytes + 0ULL, failures(drive) + 0ULL, drive.longestPause,
              1000 * away(drive));
        QVERIFY(failures(drive) > drive.flipped * 8 / 10 && failures(drive) < drive.flipped * 2);
        QCOMPARE(told.counterJumps, 0ULL);
        QVERIFY(!told.latch.isSet());
        QVERIFY(away(drive) < 0.02);
        for (int i = 0; i < drive.engine.controllers(); ++i) {
            QVERIFY(drive.engine.controller(i).readings().setups == 1);
            QCOMPARE(drive.robot.controller(i).timeout(), 0.2);
            for (int motor : {0, 1})
                QCOMPARE(drive.robot.controller(i).channel(motor).pid().qpps, 150000.0);
        }
    }

    void aCleanLineLosesNothing() {
        VirtualDrive drive(0);
        drive.run(1, 0.001); // with the set-up
        drive.longestPause = 0;
        drive.run(60, 0.001);
        QCOMPARE(failures(drive), 0ULL);
        QCOMPARE(drive.halts, 0);
        QVERIFY2(drive.longestPause < 0.03, saying(drive.longestPause));
        drive.rest(2);
        QVERIFY2(away(drive) < 0.005, saying(away(drive)));
    }

    // The machine, or a debugger, holds it for half a second: the controllers were asked nothing.
    void aPauseOfTheProgramIsNoSilenceOfTheControllers() {
        VirtualDrive drive(0);
        drive.run(2, 0.001);
        drive.stall(0.5);
        drive.run(0.05, 0.001);
        for (int i = 0; i < drive.engine.controllers(); ++i)
            QVERIFY2(drive.engine.controller(i).isReady(), qPrintable(drive.engine.controller(i).error()));
        drive.rest(1);
        QCOMPARE(drive.engine.report().counterJumps, 0ULL);
        QVERIFY2(away(drive) < 0.01, saying(away(drive)));
    }

    // Settings that are changed while the daemon ends do not let it drive again.
    void whoIsRetiredDrivesNoMore() {
        VirtualDrive drive(0);
        drive.run(2, 0.001);
        QVERIFY(drive.engine.controller(0).isReady() && drive.engine.controller(1).isReady());
        drive.engine.retire("the daemon is stopping");
        Settings settings;
        declareMotorSettings(settings);
        drive.engine.configure(MotorSettings::from(settings));
        const auto acquired = drive.engine.drive().acquire(2, "another", 10, 10);
        QVERIFY(!acquired);
        VERIFY_CONTAINS(acquired.error().message, QString("the daemon is stopping"));
    }

    // A wheel whose controller is not open would be left behind.
    void wheelsThatWaitForAControllerAreToldOn() {
        Settings values;
        declareMotorSettings(values);
        const MotorSettings both = MotorSettings::from(values);
        MotorSettings one = both;
        one.controllers.resize(1);
        for (WheelMount &wheel : one.wheels)
            if (wheel.controller > 0)
                wheel = WheelMount::none();
        DriveEngine engine(one);
        QCOMPARE(engine.report().unopened, QString());
        engine.configure(both);
        VERIFY_CONTAINS(engine.report().unopened, QString("the wheels need controller 2"));
        VERIFY_CONTAINS(engine.report().haltReason, QString("the wheels need controller 2"));
        QVERIFY(!engine.drive().acquire(1, "test", 10, 1));
    }

    void drivingNeedsNoMoreMemory() {
        constexpr double coarse = 0.02; // wheels need no more here
        VirtualDrive drive(1e-3);
        verifyTrafficNeedsNoMoreMemory([&](double seconds) { drive.run(seconds, coarse); },
                                       [&] { return drive.bytes; });
    }

private:
    static quint64 failures(VirtualDrive &drive) {
        quint64 all = drive.line.strayBytes();
        for (int i = 0; i < drive.engine.controllers(); ++i) {
            const auto &counts = drive.line.counts(drive.engine.controller(i));
            all += counts.timeouts + counts.crcErrors + counts.unexpected;
        }
        return all;
    }

    // Metres from the odometry to the body.
    static double away(VirtualDrive &drive) {
        const Pose2D pose = drive.engine.report().pose;
        return std::hypot(pose.x - drive.truth.x, pose.y - drive.truth.y);
    }
};
