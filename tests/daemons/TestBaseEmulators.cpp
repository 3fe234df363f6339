// The emulated motor controllers of other makers, byte for byte as their wire facts have it: what they
// answer, how fast they turn, what keeps them driving, and what each does when its host is silent.
#include "daemons/simulator/Drivetrain.h"

using namespace hermes;
using namespace hermes::simulator;

namespace {

QByteArray hex(const char *digits) {
    return QByteArray::fromHex(digits);
}

quint16 crcOf(const QByteArray &bytes, quint16 polynomial) {
    quint16 crc = 0;
    for (const char byte : bytes) {
        crc = quint16(crc ^ quint8(byte) << 8);
        for (int bit = 0; bit < 8; ++bit)
            crc = quint16(crc & 0x8000 ? crc << 1 ^ polynomial : crc << 1);
    }
    return crc;
}

/// Of a VESC.
QByteArray vesc(const QByteArray &payload) {
    const quint16 crc = crcOf(payload, 0x1021);
    const QByteArray size = payload.size() > 255
                                ? QByteArray(1, 3) + char(payload.size() >> 8) + char(payload.size())
                                : QByteArray(1, 2) + char(payload.size());
    return size + payload + char(crc >> 8) + char(crc) + char(3);
}

/// Of an OpenCR: instruction and parameters, stuffed already.
QByteArray dynamixel(const QByteArray &content) {
    const QByteArray packet =
        hex("FFFFFD00C8") + char(content.size() + 2) + char((content.size() + 2) >> 8) + content;
    const quint16 crc = crcOf(packet, 0x8005);
    return packet + char(crc) + char(crc >> 8);
}

const QByteArray heartbeat = hex("FFFFFD00C806000313000137A7");
const QByteArray heartbeat2 = dynamixel(hex("03130002"));
const QByteArray twist = hex("FFFFFD00C81D000396000A00000000000000000000000000000000000000320000004D37");
const QByteArray rpm3000 = hex("02050800000BB8F80403");
const QByteArray rpm3000Second = hex("0207220A0800000BB8701303");
const QByteArray selective = hex("0205320000A180F7AA03");

} // namespace

class TestBaseEmulators : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() { options_ = {}; }

    void answers_data() {
        QTest::addColumn<QString>("kind");
        QTest::addColumn<QByteArray>("sent");
        QTest::addColumn<QByteArray>("answer");
        const auto row = [](const char *kind, const char *name, const QByteArray &sent,
                            const QByteArray &answer) {
            QTest::addRow("%s: %s", kind, name) << QString(kind) << sent << answer;
        };
        row("vesc", "speed is not answered", rpm3000, "");
        row("vesc", "firmware", hex("020100000003"), vesc(hex("00070073696D00")));
        row("vesc", "a selection, at rest", selective, vesc(hex("320000A1800000000000F00000000000")));
        row("vesc", "after noise", hex("55AA") + hex("020100000003"), vesc(hex("00070073696D00")));
        row("vesc", "after half a packet", hex("0205") + selective + selective + selective,
            vesc(hex("320000A1800000000000F00000000000")) + vesc(hex("320000A1800000000000F00000000000")) +
                vesc(hex("320000A1800000000000F00000000000")));
        row("vesc", "a wrong checksum", hex("020100000103"), "");
        row("vesc", "the second one", vesc(hex("220A320000A180")),
            vesc(hex("320000A1800000000000F00000000000")));
        row("vesc", "one that is not there", vesc(hex("220B320000A180")), "");
        row("vesc", "unknown", vesc(hex("77")), "");
        row("opencr", "ping", hex("FFFFFD00C80300013BFA"), dynamixel(hex("5500000001")));
        row("opencr", "ping of another one", hex("FFFFFD0001030001194E"), "");
        row("opencr", "heartbeat", heartbeat, dynamixel(hex("5500")));
        row("opencr", "velocity", twist, dynamixel(hex("5500")));
        row("opencr", "24 items, at rest", hex("FFFFFD00C807000278001800A87F"),
            dynamixel(hex("5500") + QByteArray(24, 0)));
        row("opencr", "stuffed", dynamixel(hex("039600FFFFFDFD00")) + dynamixel(hex("0296000400")),
            dynamixel(hex("5500")) + dynamixel(hex("5500FFFFFDFD00")));
        row("opencr", "a wrong checksum", hex("FFFFFD00C80300013BFB"), "");
        row("opencr", "beyond the items", dynamixel(hex("02B0000A00")), dynamixel(hex("5507")));
        row("opencr", "an item that is only read", dynamixel(hex("03880001000000")), dynamixel(hex("5507")));
        row("opencr", "unknown instruction", dynamixel(hex("44")), dynamixel(hex("5502")));
        row("roboteq", "speed", "!G 1 500\r", "!G 1 500\r+\r");
        row("roboteq", "time-out", "^RWD 200\r~RWD\r", "^RWD 200\r+\r~RWD\rRWD=200\r");
        row("roboteq", "time-out as it comes", "~RWD\r", "~RWD\rRWD=1000\r");
        row("roboteq", "firmware", "?FID\r", "?FID\rFID=Roboteq v1.8 simulated\r");
        row("roboteq", "counts", "?C\r?C 2\r", "?C\rC=0:0\r?C 2\rC=0\r");
        row("roboteq", "voltage, currents", "?V\r?A\r", "?V\rV=120:240:5000\r?A\rA=0:0\r");
        row("roboteq", "no echo", "^ECHOF 1\r?C 1\r", "^ECHOF 1\r+\rC=0\r");
        row("roboteq", "wrong", "!G 3 500\r!G 1\r?X\r^RWD x\r", "!G 3 500\r-\r!G 1\r-\r?X\r-\r^RWD x\r-\r");
    }

    void answers() {
        QFETCH(QString, kind);
        QFETCH(QByteArray, sent);
        make(kind);
        QTEST(send(sent), "answer");
    }

    // The fact sheet's own example: 3000 erpm, 24.8 V, -1234 steps, no fault.
    void vescTellsItsMotion() {
        make("vesc");
        send(rpm3000);
        pass(0.8, 24.8);
        emulator_->channel(0).setCount(-1234);
        QCOMPARE(send(selective), hex("0210320000A18000000BB800F8FFFFFB2E0048F903"));
        const QByteArray all = send(hex("020104408403"));
        QCOMPARE(all.size(), 79);
        QCOMPARE(all, vesc(all.mid(2, 74)));
        QCOMPARE(all.mid(2 + 23, 4), hex("00000BB8")); // behind temperatures, currents and duty
        QCOMPARE(all.mid(2 + 27, 2), hex("00F8"));
        QCOMPARE(all.mid(2 + 45, 4), hex("FFFFFB2E"));
        QCOMPARE(all.mid(2 + 58, 1), hex("00")); // its id
        QCOMPARE(all.mid(2 + 73, 1), hex("00")); // not timed out
        pass(1);
        QCOMPARE(send(hex("020104408403")).mid(2 + 73, 1), hex("01"));
    }

    void vescTellsItsTimeout() {
        options_.vesc.timeout = 0.2;
        options_.vesc.brakeCurrent = 5;
        make("vesc");
        const QByteArray answer = send(hex("020111021003"));
        QCOMPARE(answer.left(1), hex("03")); // longer than 255 bytes
        const QByteArray conf = answer.mid(3, answer.size() - 6);
        QCOMPARE(answer, vesc(conf));
        QCOMPARE(conf.left(1) + conf.mid(5, 9), hex("1100000000C840A00000"));
    }

    void speeds_data() {
        QTest::addColumn<QString>("kind");
        QTest::addColumn<QByteArray>("sent");
        QTest::addColumn<double>("left"); // counts/s
        QTest::addColumn<double>("right");
        const auto row = [](const char *kind, const char *name, const QByteArray &sent, double left,
                            double right) {
            QTest::addRow("%s: %s", kind, name) << QString(kind) << sent << left << right;
        };
        const double turn = 4096 / (2 * M_PI) / 0.033; // counts in a metre
        row("vesc", "one", rpm3000, 300, 0);
        row("vesc", "backward", hex("020508FFFFF448902403"), -300, 0);
        row("vesc", "the other one", rpm3000Second, 0, 300);
        row("vesc", "slower than it can", vesc(hex("0800000383")), 0, 0);
        row("vesc", "as slow as it can", vesc(hex("0800000384")), 90, 0);
        row("vesc", "duty 0.1", hex("02050500002710AE1703"), 200, 0);
        row("vesc", "no current", hex("02050600000000CD8503"), 0, 0);
        row("opencr", "forward and left", heartbeat + twist, 0.06 * turn, 0.14 * turn);
        row("opencr", "not connected", twist, 0, 0);
        row("opencr", "no torque", heartbeat + dynamixel(hex("03950000")) + twist, 0, 0);
        row("roboteq", "both", "!G 1 500\r!G 2 -250\r", 5000, -2500);
        row("roboteq", "too fast", "!G 1 5000\r", 10000, 0);
        row("roboteq", "line feeds", "!G 1 500\r\n!G 2 100\r\n", 5000, 1000);
    }

    void speeds() {
        QFETCH(QString, kind);
        QFETCH(QByteArray, sent);
        QFETCH(double, left);
        QFETCH(double, right);
        make(kind);
        send(sent);
        pass(0.4);
        QVERIFY2(std::abs(emulator_->channel(0).speed() - left) < 0.01 * std::abs(left) + 1,
                 saying(emulator_->channel(0).speed()));
        QVERIFY2(std::abs(emulator_->channel(1).speed() - right) < 0.01 * std::abs(right) + 1,
                 saying(emulator_->channel(1).speed()));
    }

    void silenceStopsIt_data() {
        QTest::addColumn<QString>("kind");
        QTest::addColumn<QByteArray>("start");
        QTest::addColumn<QByteArray>("keep");  // in turn with the start
        QTest::addColumn<QByteArray>("other"); // keeps nothing
        QTest::addColumn<double>("timeout");   // seconds
        QTest::addColumn<double>("braking");   // seconds
        const auto row = [](const char *name, const char *kind, const QByteArray &start,
                            const QByteArray &keep, const QByteArray &other, double timeout, double braking) {
            QTest::newRow(name) << QString(kind) << start << keep << other << timeout << braking;
        };
        row("vesc coasts", "vesc", rpm3000, rpm3000, selective + hex("020104408403"), 1, 2);
        row("vesc kept by another value", "vesc", rpm3000, vesc(hex("0C01F4")), selective, 1, 2);
        row("the second vesc has its own", "vesc", rpm3000Second, rpm3000Second, rpm3000, 1, 2);
        row("opencr", "opencr", heartbeat + twist, heartbeat2, heartbeat2 + heartbeat2 + twist, 0.5, 0.2);
        row("roboteq", "roboteq", "!G 1 500\r!G 2 500\r", "!G 1 500\r", "?C\r^ECHOF 1\r!G 9 9\r", 1, 0.2);
    }

    void silenceStopsIt() {
        QFETCH(QString, kind);
        QFETCH(QByteArray, start);
        QFETCH(QByteArray, keep);
        QFETCH(QByteArray, other);
        QFETCH(double, timeout);
        QFETCH(double, braking);
        make(kind);
        QCOMPARE(emulator_->timeout(), timeout);
        const int motor = start == rpm3000Second;
        const auto speed = [&] { return std::abs(emulator_->channel(motor).speed()); };
        for (int i = 0; i < 4; ++i) {
            send(i % 2 == 0 ? start : keep);
            pass(0.95 * timeout);
            QVERIFY(speed() > 80);
        }
        const double full = speed();
        send(other);
        pass(0.05 * timeout + 0.1);
        QCOMPARE(speed() > full / 2, braking > 1); // it rolls, or it brakes
        for (int i = 0; i < 10 * braking; ++i) {
            send(other);
            pass(0.1);
        }
        QCOMPARE(emulator_->channel(motor).speed(), 0.0);
        QVERIFY(emulator_->counts().timeouts >= 1);
    }

    void stuckTimeoutDrivesOn_data() { rowsOf("kind", {"vesc", "opencr", "roboteq"}); }

    void stuckTimeoutDrivesOn() {
        drive();
        emulator_->faults().stuckTimeout = true;
        pass(5);
        QVERIFY(std::abs(emulator_->channel(0).speed()) > 80);
    }

    void roboteqResumes() {
        make("roboteq");
        send("!G 1 500\r!G 2 500\r");
        pass(2);
        QCOMPARE(emulator_->channel(1).speed(), 0.0);
        send("!G 1 0\r"); // the other one runs again
        pass(0.3);
        QVERIFY(emulator_->channel(0).speed() == 0 && emulator_->channel(1).speed() > 4900);
    }

    void openCrDoesNotResume() {
        make("opencr");
        send(heartbeat + twist);
        pass(1);
        QCOMPARE(send(dynamixel(hex("020F000100"))), dynamixel(hex("550000"))); // not connected
        send(heartbeat2);
        pass(0.3);
        QVERIFY(emulator_->channel(1).speed() == 0);
        QCOMPARE(send(dynamixel(hex("020F000100"))), dynamixel(hex("550001")));
    }

    void openCrDebugHasNoTimeout() {
        make("opencr");
        send(dynamixel(hex("030E0001")) + twist);
        pass(3);
        QVERIFY(emulator_->channel(1).speed() > 2000);
    }

    void openCrTellsItsWheels() {
        make("opencr");
        send(heartbeat + twist);
        pass(0.4);
        emulator_->channel(0).setCount(0x01020304);
        emulator_->channel(1).setCount(-2);
        const QByteArray told = send(hex("FFFFFD00C807000278001800A87F"));
        QCOMPARE(told, dynamixel(told.mid(7, told.size() - 9)));
        QCOMPARE(told.mid(9 + 16, 8), hex("04030201FEFFFFFF"));
        const double unit = 0.229 / 60 * 4096;
        QVERIFY(std::abs(quint8(told[9 + 12]) - emulator_->channel(1).speed() / unit) <= 1);
    }

    void brakeCurrentBrakes() {
        make("vesc");
        double left[2];
        for (const int i : {0, 1}) {
            send(rpm3000);
            pass(0.5);
            send(i == 0 ? hex("02050600000000CD8503") : hex("02050700001388217403"));
            pass(0.1);
            left[i] = emulator_->channel(0).speed();
        }
        QVERIFY2(left[0] > 150 && left[1] < 0.8 * left[0], saying(left[1]));
        pass(0.5);
        QCOMPARE(emulator_->channel(0).speed(), 0.0);
    }

    void servoIsKept() {
        Drivetrain::Options robot;
        robot.kind = "vesc";
        Drivetrain drivetrain(robot);
        QVERIFY(!drivetrain.servo());
        const QByteArray half = vesc(hex("0C01F4"));
        drivetrain.receive(0, reinterpret_cast<const quint8 *>(half.constData()), std::size_t(half.size()),
                           0);
        QCOMPARE(drivetrain.servo(), std::optional<double>(0.5));
    }

    void faults_data() { rowsOf("kind", {"vesc", "opencr", "roboteq"}); }

    void faults() {
        drive();
        QVERIFY(!emulator_->setFault("nothing", 0));
        for (const char *kind : motorKind(qPrintable(kind_)).faults)
            QVERIFY(emulator_->setFault(kind, 0, false));
        const QByteArray asks = asking();
        const QByteArray whole = send(asks);
        QVERIFY(!whole.isEmpty());
        emulator_->setFault("slow", 0.3);
        send(asks);
        QCOMPARE(delay_, 0.3);
        emulator_->setFault("slow", 0, false);
        emulator_->setFault("corrupt", 1);
        QVERIFY(send(asks) != whole);
        emulator_->setFault("corrupt", 0, false);
        send(kind_ == "roboteq" ? "\r" : "");
        emulator_->setFault("latched", 0);
        const double before = emulator_->channel(0).speed();
        send(stopping());
        pass(0.3);
        QVERIFY(std::abs(emulator_->channel(0).speed() - before) < 0.02 * std::abs(before));
        emulator_->setFault("latched", 0, false);
        emulator_->setFault("mute", 0);
        QCOMPARE(send(asks), QByteArray());
        emulator_->setFault("mute", 0, false);
        emulator_->setFault("deaf", 0);
        QCOMPARE(send(asks + stopping()), QByteArray());
        pass(0.1);
        QVERIFY(emulator_->channel(0).speed() != 0);
        emulator_->setFault("deaf", 0, false);
        emulator_->setFault("brownout", 0.5);
        pass(0.4);
        QCOMPARE(send(asks), QByteArray());
        pass(1.5);
        QCOMPARE(emulator_->channel(0).speed(), 0.0);
        QVERIFY(!send(asks).isEmpty());
    }

private:
    void make(const QString &kind) {
        kind_ = kind;
        options_.vesc.ids[1] = 10;
        options_.vesc.motor.fullSpeed = 2000;
        options_.openCr.motor.fullSpeed = 5000;
        options_.roboteq.motor.fullSpeed = 10000;
        emulator_ = motorKind(qPrintable(kind)).make(options_, 0);
    }
    /// One of the row's kind, at speed.
    void drive() {
        QFETCH(QString, kind);
        make(kind);
        send(kind == "vesc" ? rpm3000 : kind == "opencr" ? heartbeat + twist : "!G 1 500\r");
        pass(0.3);
    }
    QByteArray asking() const {
        return kind_ == "vesc" ? selective : kind_ == "opencr" ? hex("FFFFFD00C80300013BFA") : "?FID\r";
    }
    QByteArray stopping() const {
        return kind_ == "vesc"     ? hex("02050600000000CD8503")
               : kind_ == "opencr" ? heartbeat2 + dynamixel(hex("039600") + QByteArray(24, 0))
                                   : "!G 1 0\r";
    }
    QByteArray send(const QByteArray &bytes) {
        QByteArray answer;
        for (const char byte : bytes) {
            for (const auto &part : emulator_->receive(quint8(byte), 0)) {
                answer +=
                    QByteArray(reinterpret_cast<const char *>(part.bytes.data()), int(part.bytes.size()));
                delay_ = part.delay;
            }
        }
        return answer;
    }
    void pass(double seconds, double voltage = 24) {
        for (int i = 0; i < int(std::lround(seconds * 1000)); ++i)
            emulator_->advance(0.001, voltage);
    }

    MotorOptions options_;
    QString kind_;
    std::unique_ptr<MotorEmulator> emulator_;
    double delay_ = 0;
};
