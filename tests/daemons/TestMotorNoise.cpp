// Driving over a serial line on which one byte in 1,000 has a bit flipped, both ways: for $HERMES_NOISE_S
// seconds, 15 where it is not set.
#include "MachineStalls.h"
#include "MotorFixture.h"

using namespace hermes;
using namespace hermes::motorcontrol;
using namespace hermes::simulator;

class TestMotorNoise : public QObject, MotorFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        setUp();
        plugServer();
    }
    void cleanup() { tearDown(); }

    void flippedBytesStopAndMoveNothing() {
        rig_->setFlips(1e-3);
        launchReady(); // set up over the noisy line
        const quint64 before = rig_->noise().flipped;
        rig_->setFlips(1e-3);
        call("control.acquire", {{"timeout_s", 10}});
        MachineStalls stalls;
        driveAbout(qEnvironmentVariable("HERMES_NOISE_S", "15").toDouble());
        const RoboClawRig::Noise noise = rig_->noise();
        QVERIFY(noise.flipped > 0);
        qInfo("%llu bytes, at most %.0f ms between two set-points that a controller carried out",
              noise.bytes + 0ULL, 1000 * noise.longestPause);
        QCOMPARE(noise.foreign, 0);
        QVERIFY(noise.longestPause < 0.25 + stalls.takeLongest());

        call("motor.stop");
        QTRY_VERIFY(rig_->fastest() < 10);
        passCycles(10); // with readings
        compareErrorsOfBothSides(before + rig_->noise().flipped);
        QCOMPARE(state()["counter_jumps"].toInt(), 0);
        QVERIFY(state()["latched"].toObject().isEmpty());
        const QJsonObject pose = state()["pose"].toObject();
        const vectorlib::Pose2D truth = rig_->pose();
        const double away = std::hypot(pose["x"].toDouble() - truth.x, pose["y"].toDouble() - truth.y);
        QVERIFY2(away < 0.02, saying(away));
        rig_->with([](auto &all) {
            for (const RoboClawEmulator &controller : all) {
                QCOMPARE(controller.timeout(), 0.2);
                for (int motor : {0, 1})
                    QCOMPARE(controller.channel(motor).pid().qpps, 150000.0);
            }
        });
    }

private:
    // Speeds that change all the time, so that an old or a damaged set-point is another one.
    void driveAbout(double seconds) {
        const double begin = RoboClawRig::now();
        for (double t = 0; t < seconds; t = RoboClawRig::now() - begin) {
            const QJsonObject reply = call("motor.drive", {{"vx", 0.4 * std::sin(t)},
                                                           {"vy", 0.2 * std::sin(0.7 * t)},
                                                           {"omega", 0.5 * std::cos(1.3 * t)}});
            QVERIFY2(!reply.contains("failed"), qPrintable(reply["failed"].toString()));
            QTest::qWait(40); // the pace of a client
        }
    }

    void compareErrorsOfBothSides(quint64 flipped) {
        quint64 here = 0, there = 0;
        for (int i = 0; i < 2; ++i) {
            const QJsonObject told = healthItem(QString("controller_%1").arg(i + 1))["values"].toObject();
            for (const char *kind : {"timeouts", "crc_errors", "unexpected"})
                here += quint64(told[kind].toDouble());
            there +=
                rig_->with([i](auto &all) { return all[i].counts().crcErrors + all[i].counts().unknown; });
        }
        qInfo("%llu bytes flipped; the daemon counts %llu failures, the controllers %llu", flipped + 0ULL,
              here + 0ULL, there + 0ULL);
        QVERIFY(here > flipped * 8 / 10 && here < flipped * 2);
        QVERIFY(there > flipped / 4);
    }
};
