// What emulated controllers do with their motors, wheels and battery.
#include "RoboClawClient.h"

using namespace hermes;
using namespace hermes::simulator;

class TestEmulatedMotors : public QObject, DrivetrainFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { make(); }

    void speedFollowsTheRamp() {
        setQpps(client);
        QVERIFY(client.speeds(0x80, 40000, -20000, 40000));
        pass(drivetrain, 0.5);
        const double half = drivetrain.controller(0).channel(0).speed();
        QVERIFY2(std::abs(half - 20000) < 1500, saying(half));
        pass(drivetrain, 1.5);
        QVERIFY(std::abs(drivetrain.controller(0).channel(0).speed() - 40000) < 400);
        QVERIFY(std::abs(drivetrain.controller(0).channel(1).speed() + 20000) < 200);
        const QByteArray speed = client.read(0x80, 19);
        QVERIFY(std::abs(integer(speed, 0, 4) + 20000) < 200);
        QCOMPARE(int(speed[4]), 1);
        QVERIFY(std::abs(client.count(0x80, 0) - 60000) < 3000); // 0.5 v t + v t
        QVERIFY(client.write(0x80, 37, number(500000, 4) + number(0, 4)));
        pass(drivetrain, 1);
        QVERIFY(drivetrain.controller(0).channel(0).speed() < 151000); // QPPS
        QCOMPARE(drivetrain.controller(0).channel(1).speed(), 0.0);
    }

    void emergencyDecelerationStopsInTime() {
        setQpps(client);
        const int fast = 60479, slowing = 241916; // 1 m/s and 4 m/s^2 with wheels of 0.1 m
        QVERIFY(client.speeds(0x80, fast, fast, slowing));
        QVERIFY(client.speeds(0x81, fast, fast, slowing));
        pass(drivetrain, 2);
        QVERIFY(client.speeds(0x80, 0, 0, slowing));
        QVERIFY(client.speeds(0x81, 0, 0, slowing));
        double standing = 0;
        for (; drivetrain.isMoving() && standing < 1; standing += 0.001)
            drivetrain.advance(0.001);
        QVERIFY2(standing > 0.24 && standing < 0.25 + 0.05, saying(standing));
    }

    void dutyTurnsTheMotor() {
        QVERIFY(client.write(0x80, 34, number(16384, 2) + number(-16384, 2)));
        pass(drivetrain, 0.5);
        const double expected = 80000 * drivetrain.battery().voltage() / 24;
        QVERIFY(std::abs(drivetrain.controller(0).channel(0).speed() - expected) < 100);
        QVERIFY(std::abs(drivetrain.controller(0).channel(1).speed() + expected) < 100);
        QCOMPARE(client.read(0x80, 48), number(16384, 2) + number(-16384, 2));
        QVERIFY(client.write(0x80, 6, number(64, 1)));
        QVERIFY(client.write(0x80, 4, number(0, 1)));
        pass(drivetrain, 0.5);
        QVERIFY(!drivetrain.isMoving());
    }

    void mixedDriveNeedsBothValues() {
        const auto duties = [&] {
            pass(drivetrain, 0.01);
            const QByteArray pwm = client.read(0x80, 48);
            return QPair<int, int>(int(std::lround(integer(pwm, 0, 2) / 327.67)),
                                   int(std::lround(integer(pwm, 2, 2) / 327.67)));
        };
        const auto set = [&](int command, int value) {
            return client.write(0x80, command, number(value, 1));
        };
        QVERIFY(set(8, 127)); // forward, and no turn yet
        QCOMPARE(duties(), qMakePair(0, 0));
        QVERIFY(set(10, 0));
        QCOMPARE(duties(), qMakePair(100, 100));
        QVERIFY(set(9, 64)); // backward
        QCOMPARE(duties(), qMakePair(-50, -50));
        QVERIFY(set(12, 64)); // stands
        QVERIFY(set(11, 32)); // turns to the left
        QCOMPARE(duties(), qMakePair(-25, 25));
        QVERIFY(set(13, 127)); // full turn to the right
        QCOMPARE(duties(), qMakePair(100, -100));
        QVERIFY(set(12, 0)); // and full backward: no duty goes beyond what there is
        QCOMPARE(duties(), qMakePair(0, -100));
        QVERIFY(client.write(0x80, 34, number(0, 4)));
        QVERIFY(set(13, 64)); // after another command both must come again
        QCOMPARE(duties(), qMakePair(0, 0));
        QVERIFY(set(12, 127));
        QCOMPARE(duties(), qMakePair(100, 100));
    }

    void positionsAreReached() {
        setQpps(client);
        QVERIFY(client.write(0x80, 22, number(5000, 4)));
        const auto way = [](int acceleration, int speed, int deceleration, int position) {
            return number(acceleration, 4) + number(speed, 4) + number(deceleration, 4) + number(position, 4);
        };
        // Forward and back from where the counts are, whatever the sign of the speed.
        QVERIFY(client.write(
            0x80, 67, way(40000, 20000, 20000, 45000) + way(40000, 20000, 20000, -30000) + number(1, 1)));
        QCOMPARE(client.read(0x80, 47).toHex(), QByteArray("0000"));
        pass(drivetrain, 1);
        QVERIFY(std::abs(drivetrain.controller(0).channel(0).speed() - 20000) < 300);
        QVERIFY(std::abs(drivetrain.controller(0).channel(1).speed() + 20000) < 300);
        std::int64_t farthest = 0;
        double slowsSince = 0, seconds = 1;
        while (client.read(0x80, 47) != number(0x8080, 2) && seconds < 6) {
            pass(drivetrain, 0.01);
            seconds += 0.01;
            farthest = std::max(farthest, client.count(0x80, 0));
            if (drivetrain.controller(0).channel(0).speed() > 19500)
                slowsSince = seconds;
        }
        // 0.5 s to speed up over 5000 counts, 1 s to slow down over 10000, 25000 between: 2.75 s and the
        // approach.
        QVERIFY2(seconds > 2.7 && seconds < 3.7, saying(seconds));
        QVERIFY2(std::abs(slowsSince - 1.75) < 0.15, saying(slowsSince));
        pass(drivetrain, 1);
        QVERIFY(!drivetrain.isMoving());
        QVERIFY(std::abs(client.count(0x80, 0) - 45000) <= 30 && farthest < 45030);
        QVERIFY(std::abs(client.count(0x80, 1) + 30000) <= 30);
    }

    void positionsWaitInTheQueue() {
        setQpps(client);
        const auto go = [&](int command, int position, int buffer) {
            return client.write(0x80, command,
                                number(100000, 4) + number(20000, 4) + number(100000, 4) +
                                    number(position, 4) + number(buffer, 1));
        };
        QVERIFY(go(65, 5000, 0) && go(65, -1000, 0) && go(66, 300, 0));
        QCOMPARE(client.read(0x80, 47).toHex(), QByteArray("0100"));
        std::int64_t most = 0;
        for (int i = 0; i < 300; ++i) {
            pass(drivetrain, 0.01);
            most = std::max(most, client.count(0x80, 0));
        }
        QCOMPARE(client.read(0x80, 47).toHex(), QByteArray("8080"));
        QVERIFY(std::abs(most - 5000) <= 30 && std::abs(client.count(0x80, 0) + 1000) <= 30);
        QVERIFY(std::abs(client.count(0x80, 1) - 300) <= 30);
        QVERIFY(go(65, 50000, 0) && go(65, 60000, 0));
        pass(drivetrain, 0.2);
        QVERIFY(go(65, 0, 1)); // at once, and the others are dropped
        QCOMPARE(client.read(0x80, 47).toHex(), QByteArray("0080"));
        pass(drivetrain, 3);
        QVERIFY(std::abs(client.count(0x80, 0)) <= 30 && !drivetrain.isMoving());
    }

    void distancesAreDriven() {
        setQpps(client);
        const auto move = [&](int speed, int distance, int buffer) {
            return client.write(0x80, 41, number(speed, 4) + number(distance, 4) + number(buffer, 1));
        };
        QVERIFY(move(20000, 10000, 0));
        QVERIFY(move(-10000, 5000, 0));
        QCOMPARE(client.read(0x80, 47).toHex(), QByteArray("0180"));
        pass(drivetrain, 0.7);
        QCOMPARE(client.read(0x80, 47).toHex(), QByteArray("0080"));
        pass(drivetrain, 1);
        QCOMPARE(client.read(0x80, 47).toHex(), QByteArray("8080"));
        QVERIFY(std::abs(client.count(0x80, 0) - 5000) < 1500);
        QVERIFY(!drivetrain.isMoving());
        for (int i = 0; i < 100; ++i)
            QVERIFY(move(1000, 100000, 0));
        QCOMPARE(client.read(0x80, 47).toHex(), QByteArray("4080")); // 64 at most
        QVERIFY(move(0, 0, 1));
        pass(drivetrain, 0.5);
        QVERIFY(!drivetrain.isMoving());
    }

    void silenceStopsTheMotors() {
        setQpps(client);
        QVERIFY(client.write(0x80, 14, number(2, 1)));
        QVERIFY(client.speeds(0x80, 30000, 30000, 300000));
        for (int i = 0; i < 10; ++i) {
            pass(drivetrain, 0.1);
            client.read(0x80, 24); // any byte keeps it going
        }
        QVERIFY(drivetrain.controller(0).channel(0).speed() > 29000);
        pass(drivetrain, 0.19);
        QVERIFY(drivetrain.controller(0).channel(0).speed() > 29000);
        QCOMPARE(drivetrain.controller(0).counts().timeouts, std::uint64_t(0));
        pass(drivetrain, 0.2);
        QVERIFY(!drivetrain.isMoving());
        QCOMPARE(drivetrain.controller(0).counts().timeouts, std::uint64_t(1));
        client.read(0x80, 24);
        pass(drivetrain, 0.1);
        QVERIFY(!drivetrain.isMoving()); // it does not go on by itself
    }

    void encodersWrap() {
        QVERIFY(client.write(0x80, 22, number(-5, 4)));
        QCOMPARE(client.read(0x80, 16).left(4).toHex(), QByteArray("fffffffb"));
        setQpps(client);
        QVERIFY(client.speeds(0x80, 10000, 0, 1000000));
        pass(drivetrain, 0.1);
        QVERIFY(client.count(0x80, 0) > 0);
        QVERIFY(client.write(0x80, 20));
        QVERIFY(client.count(0x80, 0) == 0 && client.count(0x80, 1) == 0);
    }

    void batteryDrains() {
        Drivetrain::Options options;
        options.battery.capacity_Ah = 0.01;
        make(options);
        pass(drivetrain, 1);
        const auto before = integer(client.read(0x80, 24), 0, 2);
        QVERIFY(client.write(0x80, 34, number(20000, 2) + number(20000, 2)));
        pass(drivetrain, 20);
        const auto after = integer(client.read(0x80, 24), 0, 2);
        QVERIFY2(after < before - 10, saying("%1 %2", before, after));
        QVERIFY(drivetrain.battery().charge() < 0.7);
    }

    void drivingBackwardDrainsItToo() {
        const auto used = [this](int speed) {
            make();
            setQpps(client);
            for (int i = 0; i < 60; ++i) { // their time-out is not to stop them
                client.speeds(0x80, speed, speed, 100000);
                client.speeds(0x81, speed, speed, 100000);
                pass(drivetrain, 0.5);
            }
            return 1 - drivetrain.battery().charge();
        };
        const double standing = used(0), forward = used(60000), backward = used(-60000);
        QVERIFY2(forward > 2 * standing, saying("%1 %2", forward, standing));
        QVERIFY2(std::abs(backward - forward) < 0.05 * forward, saying("%1 %2", backward, forward));
    }

    void lowBatteryCutsTheMotors() {
        setQpps(client);
        QVERIFY(client.write(0x80, 57, number(210, 2) + number(340, 2)));
        QVERIFY(client.speeds(0x80, 30000, 30000, 300000));
        pass(drivetrain, 0.5);
        drivetrain.battery().setCharge(0);
        pass(drivetrain, 5);
        QVERIFY(integer(client.read(0x80, 90), 0, 4) & 0x4000);
        QVERIFY(drivetrain.controller(0).channel(0).speed() < 1000); // rolled out
        QCOMPARE(drivetrain.controller(0).channel(0).current(), 0.0);
    }

    void blockedWheelDrawsCurrent() {
        setQpps(client);
        QVERIFY(client.speeds(0x80, 60000, 60000, 300000));
        pass(drivetrain, 1);
        const double free = drivetrain.controller(0).channel(0).current();
        drivetrain.controller(0).channel(0).setBlocked(true);
        pass(drivetrain, 1);
        QCOMPARE(drivetrain.controller(0).channel(0).speed(), 0.0);
        const QByteArray currents = client.read(0x80, 49);
        QVERIFY(integer(currents, 0, 2) > 1500 && free < 2);
        QVERIFY(integer(currents, 2, 2) < 200);
        QVERIFY(client.write(0x80, 133, number(1000, 4) + number(0, 4)));
        pass(drivetrain, 0.1);
        QCOMPARE(integer(client.read(0x80, 49), 0, 2), std::int64_t(1000));
        QVERIFY(integer(client.read(0x80, 90), 0, 4) & 0x10000);
        pass(drivetrain, 30);
        QVERIFY(integer(client.read(0x80, 82), 0, 2) > 255);
    }

    void brokenEncoderStandsStill() {
        setQpps(client);
        drivetrain.wheel(0).setEncoderBroken(true);
        QVERIFY(client.speeds(0x80, 10000, 10000, 300000));
        pass(drivetrain, 1);
        QCOMPARE(client.count(0x80, 0), std::int64_t(0));
        QVERIFY(client.count(0x80, 1) > 8000);
        QVERIFY(drivetrain.controller(0).channel(0).speed() > 15000); // the control sees no motion and pushes
    }

    void emergencyStopHolds() {
        setQpps(client);
        QVERIFY(client.speeds(0x80, 10000, 10000, 300000));
        pass(drivetrain, 0.5);
        drivetrain.controller(0).faults().status = roboclaw::EmergencyStop;
        pass(drivetrain, 0.3);
        QVERIFY(!drivetrain.isMoving());
        QVERIFY(client.speeds(0x80, 10000, 10000, 300000)); // acknowledged, not obeyed
        pass(drivetrain, 0.3);
        QVERIFY(!drivetrain.isMoving());
    }

    void slipShortensTheWay() {
        Drivetrain::Options options;
        options.slip = 0.2;
        make(options);
        setQpps(client);
        QVERIFY(client.speeds(0x80, 30000, 30000, 300000));
        QVERIFY(client.speeds(0x81, 30000, 30000, 300000));
        pass(drivetrain, 2);
        const double rim = 30000 / 38000.0 * 2 * M_PI * 0.1;
        QVERIFY(std::abs(drivetrain.advance(0.001).vx - 0.8 * rim) < 0.01 * rim);
    }

    void wheelsSlipEachByItself() {
        const auto drive = [this](std::uint64_t seed) { // for 20 s; where it comes to
            Drivetrain::Options options;
            options.slip = 0.1;
            options.slipSpread = 0.03;
            options.seed = seed;
            make(options);
            setQpps(client);
            client.speeds(0x80, 76000, 76000, 3000000);
            client.speeds(0x81, 76000, 76000, 3000000);
            pass(drivetrain, 1);
            Pose2D pose;
            for (int i = 0; i < 20000; ++i)
                pose = pose * drivetrain.advance(0.001).motion(0.001);
            return pose;
        };
        const double way = 20 * 2 * 2 * M_PI * 0.1; // of the rims
        const Pose2D pose = drive(1);
        const double share = std::hypot(pose.x, pose.y) / way;
        QVERIFY2(share > 0.8 && share < 0.93, saying(share));
        QVERIFY(std::abs(pose.theta) > 0.01);
        QCOMPARE(drive(1).theta, pose.theta); // the same seed, the same ground
        QVERIFY(drive(2).theta != pose.theta);
    }
};
