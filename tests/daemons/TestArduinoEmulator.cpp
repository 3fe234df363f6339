// The emulated Arduino, by a host that is written from the description of its protocol alone.
#include "daemons/simulator/Drivetrain.h"

using namespace hermes;
using namespace hermes::simulator;

class TestArduinoEmulator : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() { make({}); }

    void answers_data() {
        QTest::addColumn<QByteArray>("sent");
        QTest::addColumn<QByteArray>("answer");
        const auto row = [](const char *name, const char *sent, const char *answer) {
            QTest::newRow(name) << QByteArray(sent) << QByteArray(answer);
        };
        row("speed", "m 10 -10\r", "OK\r\n");
        row("power off", "m 0 0\r", "OK\r\n");
        row("raw power", "o 120 120\r", "OK\r\n");
        row("counts", "e\r", "1234 -56\r\n");
        row("counts to 0", "r\re\r", "OK\r\n0 0\r\n");
        row("gains", "u 20:12:0:50\r", "OK\r\n");
        row("speed of the line", "b\r", "57600\r\n");
        row("unknown", "y 1 2\r", "Invalid Command\r\n");
        row("nothing", "\r", "Invalid Command\r\n");
        row("line feeds", "b\r\ne\r\n", "57600\r\n1234 -56\r\n");
        row("the last letter counts", "xyzb\r", "57600\r\n");
        row("no end", "e", "");
        row("a missing argument", "m 10\r", "OK\r\n");
    }

    void answers() {
        QFETCH(QByteArray, sent);
        arduino().channel(0).setCount(1234);
        arduino().channel(1).setCount(-56);
        QTEST(send(sent), "answer");
    }

    void speedIsInCountsOfAFrame() {
        send("m 100 -50\r");
        pass(0.5);
        QVERIFY2(std::abs(arduino().channel(0).speed() - 3030) < 10, saying(arduino().channel(0).speed()));
        QVERIFY(std::abs(arduino().channel(1).speed() + 1515) < 10);
        const auto before = counts();
        pass(1);
        QVERIFY(std::abs(counts()[0] - before[0] - 3030) < 10);
        QVERIFY(std::abs(counts()[1] - before[1] + 1515) < 10);
        send("m 1 0.9\r"); // whole numbers
        pass(0.5);
        QVERIFY(std::abs(arduino().channel(0).speed() - 30.3) < 1 && arduino().channel(1).speed() == 0);
    }

    void missingArgumentTurnsOneWheel() {
        send("m 100\r");
        pass(0.5);
        QVERIFY(arduino().channel(0).speed() > 3000 && arduino().channel(1).speed() == 0);
        QVERIFY(drivetrain_.advance(0.001).omega < -0.1); // about the wheels that stand
    }

    void zeroTakesThePowerAtOnce() {
        send("m 1000 1000\r");
        pass(0.5);
        QVERIFY(arduino().channel(0).duty() > 0.1);
        send("m 0 0\r");
        drivetrain_.advance(0.001);
        QCOMPARE(arduino().channel(0).duty(), 0.0);
    }

    void rawPowerIsOf255() {
        send("o 120 -300\r");
        pass(0.5);
        QVERIFY(std::abs(arduino().channel(0).duty() - 120 / 255.) < 1e-9);
        QCOMPARE(arduino().channel(1).duty(), -1.0);
    }

    void silenceStopsIt_data() { rowsOf("keptBy", {"m 100 100\r", "o 50 50\r"}); }

    void silenceStopsIt() {
        QFETCH(QString, keptBy);
        for (int i = 0; i < 3; ++i) {
            send(keptBy.toLatin1());
            pass(1.9);
            QVERIFY(drivetrain_.isMoving());
        }
        for (const char *other : {"e\r", "b\r", "u 20:12:0:50\r", "r\r", "?\r"})
            send(other); // feed nothing
        pass(0.2);
        QVERIFY(!drivetrain_.isMoving());
        QCOMPARE(arduino().counts().timeouts, std::uint64_t(1));
        pass(5);
        QCOMPARE(arduino().counts().timeouts, std::uint64_t(1));
        send(keptBy.toLatin1());
        pass(0.5);
        QVERIFY(drivetrain_.isMoving());
    }

    void wheelsBrakeOrRoll_data() { rowsOf("bridge", {"brakes", "coasts"}); }

    void wheelsBrakeOrRoll() {
        QFETCH(QString, bridge);
        ArduinoEmulator::Options options;
        options.timeout = 0.2;
        options.coasts = bridge == "coasts";
        make(options);
        send("m 2000 2000\r");
        pass(0.19);
        const double before = drivetrain_.wheelSpeeds()[0];
        pass(0.11);
        const double left = drivetrain_.wheelSpeeds()[0] / before;
        QVERIFY2(options.coasts ? left > 0.5 : left < 0.05, saying(left));
        pass(2);
        QVERIFY(!drivetrain_.isMoving());
    }

    void countsGoRound() {
        arduino().channel(0).setCount(2147483000);
        arduino().channel(1).setCount(-2147483000);
        send("m 100 -100\r");
        pass(1);
        QVERIFY2(counts()[0] < -2147480000 && counts()[1] > 2147480000, saying(counts()[0]));
    }

    void bothWheelsOfASideTurnAlike() {
        send("m 500 1000\r");
        pass(0.5);
        const auto wheels = drivetrain_.wheelSpeeds();
        QVERIFY(wheels[0] == wheels[2] && wheels[1] == wheels[3]);
        QVERIFY(std::abs(wheels[0] - 500 / 0.033 * 2 * M_PI / 38000) < 0.05);
        const Twist2D twist = drivetrain_.advance(0.001);
        QVERIFY(std::abs(twist.vx - 0.1 * (wheels[0] + wheels[1]) / 2) < 0.01);
        QVERIFY(std::abs(twist.omega - 0.1 * (wheels[1] - wheels[0]) / 2 / 0.25) < 0.01 && twist.vy == 0);
    }

    void longArgumentIsTooMuch() {
        QCOMPARE(send("m 000000000000100 100\r"), QByteArray("OK\r\n"));
        pass(0.5);
        QVERIFY(drivetrain_.isMoving());
        QCOMPARE(send("m 0000000000000100 100\r"), QByteArray());
        pass(0.3);
        QVERIFY(!drivetrain_.isMoving());
        pass(2);
        QCOMPARE(counts(), (std::vector<int>{0, 0}));
    }

    void restartLosesTheCounts() {
        send("m 100 100\r");
        pass(0.5);
        arduino().restart(ArduinoEmulator::restartTime);
        pass(1.9);
        QCOMPARE(send("e\r"), QByteArray());
        QVERIFY(!drivetrain_.isMoving());
        pass(0.2);
        QCOMPARE(counts(), (std::vector<int>{0, 0}));
    }

    void deadIsSilentAndStands() {
        send("m 100 100\r");
        pass(0.5);
        arduino().faults().silent = true;
        QCOMPARE(send("e\r"), QByteArray());
        pass(0.5);
        QVERIFY(!drivetrain_.isMoving());
    }

    void halfALineDrivesOn() {
        send("m 100 100\r");
        pass(0.5);
        arduino().faults().drop = 1;
        QCOMPARE(send("m 50 50\r"), QByteArray());
        pass(0.5);
        QVERIFY(arduino().channel(0).speed() < 1600);
        arduino().faults() = {};
        arduino().faults().deaf = true;
        QCOMPARE(send("m 0 0\r"), QByteArray());
        pass(1);
        QVERIFY(drivetrain_.isMoving());
        pass(1);
        QVERIFY(!drivetrain_.isMoving());
    }

    void stuckTimeoutDrivesOn() {
        send("m 100 100\r");
        arduino().faults().stuckTimeout = true;
        pass(5);
        QVERIFY(drivetrain_.isMoving());
    }

    void slowAnswersAreLate() {
        arduino().faults().delay = 0.3;
        send("b\r");
        QCOMPARE(delay_, 0.3);
    }

    void damageIsAnotherCommandOrNumber() {
        arduino().faults().corrupt = 0.02;
        std::set<QByteArray> answers;
        std::set<int> speeds;
        for (int i = 0; i < 2000; ++i) {
            answers.insert(send("m 10 10\r"));
            pass(0.05);
            speeds.insert(int(std::lround(arduino().channel(0).target() * 0.033)));
        }
        QVERIFY(answers.count("OK\r\n") && answers.count("Invalid Command\r\n"));
        QVERIFY(speeds.count(10) && speeds.count(0) && *speeds.rbegin() > 10);
    }

    void lossLeavesAnswersOut() {
        arduino().faults().drop = 0.5;
        std::set<QByteArray> answers;
        for (int i = 0; i < 50; ++i)
            answers.insert(send("b\r"));
        QCOMPARE(answers, (std::set<QByteArray>{"", "57600\r\n"}));
    }

private:
    void make(const ArduinoEmulator::Options &options) {
        Drivetrain::Options robot;
        robot.base.kind = WheelBase::Kind::Differential;
        robot.kind = "arduino";
        robot.arduino = options;
        drivetrain_ = Drivetrain(robot);
    }
    MotorEmulator &arduino() { return drivetrain_.controller(0); }
    QByteArray send(const QByteArray &bytes) {
        QByteArray answer;
        for (const auto &part :
             drivetrain_.receive(0, reinterpret_cast<const std::uint8_t *>(bytes.constData()),
                                 std::size_t(bytes.size()), 0)) {
            answer += QByteArray(reinterpret_cast<const char *>(part.bytes.data()), int(part.bytes.size()));
            delay_ = part.delay;
        }
        return answer;
    }
    std::vector<int> counts() {
        const auto parts = send("e\r").trimmed().split(' ');
        return {parts.value(0).toInt(), parts.value(1).toInt()};
    }
    void pass(double seconds) {
        for (int i = 0; i < int(std::lround(seconds * 1000)); ++i)
            drivetrain_.advance(0.001);
    }

    Drivetrain drivetrain_;
    double delay_ = 0;
};
