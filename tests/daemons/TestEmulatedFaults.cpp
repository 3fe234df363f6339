// What emulated controllers, adapters and encoders do wrong when they are told to.
#include "RoboClawClient.h"

using namespace hermes;
using namespace hermes::simulator;

class TestEmulatedFaults : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        robot_ = std::make_unique<Drivetrain>();
        client_ = std::make_unique<RoboClawClient>(*robot_);
    }

    void deafControllerDrivesOnUntilItsTimeout() {
        driveOff();
        faults().deaf = true;
        QVERIFY(!client_->speeds(0x80, 0, 0, 1000000));
        QCOMPARE(client_->read(0x80, 24), QByteArray("silent"));
        passTalking(0.15, 0x81);
        QVERIFY(speed(0) > 19000);
        passTalking(0.15, 0x81); // what the other one is told does not reach it
        QVERIFY(speed(0) < 1000 && speed(1) > 19000);
        faults() = {};
        QVERIFY(client_->speeds(0x80, 5000, 5000, 1000000));
        passTalking(0.1, 0x81);
        QVERIFY(speed(0) > 4000);
    }

    void muteControllerObeys() {
        driveOff();
        faults().drop = 1;
        passTalking(0.5, 0x80);
        QVERIFY(speed(0) > 19000); // whoever talks to it keeps it going
        QVERIFY(!client_->speeds(0x80, 0, 0, 1000000));
        passTalking(0.1, 0x80);
        QCOMPARE(speed(0), 0.0);
    }

    void latchedControllerKeepsItsSetPoint() {
        driveOff();
        faults().latched = true;
        QVERIFY(client_->speeds(0x80, 0, 0, 1000000));
        QVERIFY(client_->write(0x80, 34, number(0, 4)));
        passTalking(0.5, 0x80);
        QVERIFY(speed(0) > 19000);
        pass(*robot_, 0.3); // nobody talks
        QVERIFY(speed(0) < 100);
        faults() = {};
        passTalking(0.1, 0x80);
        QCOMPARE(speed(0), 0.0);
    }

    void stuckTimeoutDrivesOn() {
        driveOff();
        faults().stuckTimeout = true;
        pass(*robot_, 3);
        QVERIFY(speed(0) > 19000 && speed(1) == 0);
        QVERIFY(client_->speeds(0x80, 0, 0, 1000000));
        pass(*robot_, 0.1);
        QCOMPARE(speed(0), 0.0);
    }

    void echoComesBeforeTheAnswer() {
        const QByteArray asked = QByteArray::fromHex("8014492D");
        faults().echo = true;
        QCOMPARE(client_->send(asked).toHex(), asked.toHex() + "ff");
        const QByteArray other = QByteArray::fromHex("8118");
        QCOMPARE(client_->send(other).left(2).toHex(), other.toHex()); // it hears all that is on its line
    }

    void brownoutForgetsEverything() {
        driveOff();
        client_->write(0x80, 253, number(0x05ABCD, 3));
        robot_->controller(0).restart(0.3);
        QCOMPARE(client_->read(0x80, 24), QByteArray("silent"));
        passTalking(0.2, 0x81);
        QCOMPARE(client_->read(0x80, 24), QByteArray("silent"));
        passTalking(0.15, 0x81);
        QCOMPARE(client_->read(0x80, 15), number(0, 1));
        QCOMPARE(client_->read(0x80, 55).right(4), number(44000, 4));
        QCOMPARE(client_->read(0x80, 252, number(5, 1)), number(0xABCD, 2));
        QCOMPARE(client_->read(0x81, 15), number(2, 1));
        QVERIFY(robot_->controller(0).channel(0).duty() == 0 && speed(1) > 19000);
        QVERIFY(std::abs(client_->count(0x80, 0)) < 10000); // counted anew while it rolls out
    }

    void swappedControllersExchangeAddresses() {
        driveOff();
        robot_->setSwapped(true);
        QVERIFY(client_->speeds(0x80, 0, 0, 1000000));
        passTalking(0.1, 0x80);
        QVERIFY(speed(0) > 19000 && speed(1) == 0);
        robot_->setSwapped(false);
        QVERIFY(client_->speeds(0x80, 0, 0, 1000000));
        passTalking(0.1, 0x80);
        QVERIFY(speed(0) == 0);
    }

    void adapterHandsOnInBunches() {
        robot_->setLatency(0, 0.016);
        const auto delayOf = [this](double gap) {
            client_->send(QByteArray::fromHex("8018"), gap);
            return client_->delay;
        };
        QVERIFY(std::abs(delayOf(1) - 0.016) < 1e-9);
        QVERIFY(std::abs(delayOf(0.004) - 0.012) < 1e-9); // goes with the first
        QVERIFY(std::abs(delayOf(0.013) - 0.016) < 1e-9); // the first has gone
        robot_->setLatency(0, 0);
        QCOMPARE(delayOf(0.001), 0.0);
    }

    void encoderJumps() {
        robot_->wheel(0).jump(5000000);
        QCOMPARE(client_->count(0x80, 0), std::int64_t(5000000));
        robot_->wheel(0).jump(-5000001);
        QCOMPARE(client_->count(0x80, 0), std::int64_t(-1));
        QVERIFY(!robot_->isMoving());
    }

    void encoderRunsBackward() {
        robot_->wheel(0).setEncoderBackward(true);
        QVERIFY(client_->write(0x80, 32, number(8192, 2)));
        passTalking(0.3, 0x80);
        QVERIFY(speed(0) > 30000 && client_->count(0x80, 0) < -5000);
        QVERIFY(integer(client_->read(0x80, 18), 0, 4) < -30000);
        QVERIFY(client_->write(0x80, 32, number(0, 2)));
        passTalking(0.5, 0x80);
        QVERIFY(speed(0) == 0);
        setQpps(*client_);
        QVERIFY(client_->speeds(0x80, 20000, 0, 1000000)); // the velocity control pushes ever more
        passTalking(1, 0x80);
        QVERIFY(speed(0) > 100000);
    }

private:
    /// Both controllers drive, with a time-out of 0.2 s, at 20000 counts/s.
    void driveOff() {
        setQpps(*client_);
        for (const int address : {0x80, 0x81}) {
            QVERIFY(client_->write(address, 14, number(2, 1)));
            QVERIFY(client_->speeds(address, 20000, 20000, 1000000));
        }
        passTalking(0.1, 0x81);
        QVERIFY(speed(0) > 19000 && speed(1) > 19000);
    }

    double speed(int controller) { return robot_->controller(controller).channel(0).speed(); }
    /// Time passes while the host talks to the other controller, which keeps the line from falling silent.
    void passTalking(double seconds, int address) {
        for (int i = 0; i < int(std::lround(seconds * 20)); ++i) {
            pass(*robot_, 0.05);
            client_->read(address, 24);
        }
    }

    RoboClawEmulator::Faults &faults() { return robot_->controller(0).faults(); }

    std::unique_ptr<Drivetrain> robot_;
    std::unique_ptr<RoboClawClient> client_;
};
