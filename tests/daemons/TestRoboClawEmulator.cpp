#include "daemons/simulator/Drivetrain.h"

#include <QtTest>

#include <cmath>

using namespace hermes;

namespace {

/// A client written from the published packet format alone; it shares no code with the product.
class Client {
public:
    explicit Client(Drivetrain &drivetrain, int line = 0)
        : drivetrain_(drivetrain)
        , line_(line) {}

    static std::uint16_t crcOf(const QByteArray &bytes) {
        std::uint32_t crc = 0;
        for (const char byte : bytes) {
            crc ^= std::uint32_t(std::uint8_t(byte)) << 8;
            for (int i = 0; i < 8; ++i)
                crc = (crc << 1) ^ ((crc & 0x8000) ? 0x11021 : 0);
        }
        return std::uint16_t(crc);
    }
    static QByteArray number(std::int64_t value, int bytes) {
        QByteArray text;
        for (int i = bytes - 1; i >= 0; --i)
            text += char(value >> 8 * i);
        return text;
    }

    QByteArray send(const QByteArray &bytes, double gap = 0.02) {
        now_ += gap;
        QByteArray answer;
        for (const auto &part :
             drivetrain_.receive(line_, reinterpret_cast<const std::uint8_t *>(bytes.constData()),
                                 std::size_t(bytes.size()), now_)) {
            answer += QByteArray(reinterpret_cast<const char *>(part.bytes.data()), int(part.bytes.size()));
            delay = part.delay;
        }
        return answer;
    }
    bool write(int address, int command, const QByteArray &data = {}) {
        QByteArray packet = QByteArray(1, char(address)) + char(command) + data;
        packet += number(crcOf(packet), 2);
        return send(packet) == QByteArray("\xFF");
    }
    /// The data of the answer, or "silent", or "wrong CRC".
    QByteArray read(int address, int command, const QByteArray &argument = {}) {
        const QByteArray asked = QByteArray(1, char(address)) + char(command) + argument;
        const QByteArray answer = send(asked);
        if (answer.isEmpty())
            return "silent";
        const QByteArray data = answer.left(answer.size() - 2);
        return answer.right(2) == number(crcOf(asked + data), 2) ? data : QByteArray("wrong CRC");
    }
    static std::int64_t integer(const QByteArray &data, int at, int size, bool isSigned = true) {
        std::int64_t value = 0;
        for (int i = 0; i < size; ++i)
            value = value << 8 | std::uint8_t(data[at + i]);
        return isSigned && value >> (8 * size - 1) ? value - (std::int64_t(1) << 8 * size) : value;
    }
    bool speeds(int address, int m1, int m2, int acceleration) {
        return write(address, 40, number(acceleration, 4) + number(m1, 4) + number(m2, 4));
    }
    std::int64_t count(int address, int motor) { return integer(read(address, 78), motor * 4, 4); }

    double delay = 0;

private:
    Drivetrain &drivetrain_;
    int line_;
    double now_ = 0;
};

void pass(Drivetrain &drivetrain, double seconds) {
    for (int i = 0; i < int(std::lround(seconds * 1000)); ++i)
        drivetrain.advance(0.001);
}

void setQpps(Client &client, int qpps) {
    for (const int address : {0x80, 0x81}) {
        for (const int command : {28, 29})
            QVERIFY(client.write(address, command,
                                 Client::number(0x4000, 4) + Client::number(0x10000, 4) +
                                     Client::number(0x8000, 4) + Client::number(qpps, 4)));
    }
}

} // namespace

class TestRoboClawEmulator : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void answersAsPublished_data();
    void answersAsPublished();
    void bothAddressesShareALine();
    void linesOfTheirOwn();
    void gapsAndDamageAreSilent();
    void everyReadAnswers();
    void settingsAreKept();
    void speedFollowsTheRamp();
    void emergencyDecelerationStopsInTime();
    void dutyTurnsTheMotor();
    void distancesAreDriven();
    void silenceStopsTheMotors();
    void encodersWrap();
    void batteryDrains();
    void lowBatteryCutsTheMotors();
    void blockedWheelDrawsCurrent();
    void brokenEncoderStandsStill();
    void faultsOfTheLine();
    void statusBitsOfBothWidths();
    void emergencyStopHolds();
    void wheelsMoveTheBody_data();
    void wheelsMoveTheBody();
    void arcsAreExact();
    void wallsHoldTheRobot();
    void cornersHoldTheRobot();
    void slipShortensTheWay();
};

void TestRoboClawEmulator::answersAsPublished_data() {
    QTest::addColumn<QByteArray>("sent");
    QTest::addColumn<QByteArray>("answer");
    const auto row = [](const char *name, const char *sent, const char *answer) {
        QTest::newRow(name) << QByteArray::fromHex(sent) << QByteArray::fromHex(answer);
    };
    row("both speeds", "802500000000000000003404", "FF");
    row("second controller", "8125FFFFF63C000009C4D2B7", "FF");
    row("time-out", "800E0548F0", "FF");
    row("reset", "8014492D", "FF");
    row("PID", "801C0000400000010000000080000000ABE026FA", "FF");
    row("key", "805EE22EAB7AE4A6", "FF");
    row("battery", "8018", "00FC1969"); // 25.2 V
    row("counts", "804E", "0000000000000000C89A");
    row("buffers", "802F", "8080FDDF");
    row("wrong CRC", "802500000000000000003405", "");
    row("no such command", "8048", "");
    row("another address",
        "82250000000000000000"
        "EA8E",
        "");
    row("two in one", "80148018", "");
    row("version", "8015",
        "526F626F436C6177203278343541 2076342E322E380A00"
        "0000");
}

void TestRoboClawEmulator::answersAsPublished() {
    QFETCH(QByteArray, sent);
    QFETCH(QByteArray, answer);
    Drivetrain drivetrain;
    pass(drivetrain, 0.001);
    Client client(drivetrain);
    if (QByteArray(QTest::currentDataTag()) == "version") // its CRC is that of the oracle
        answer = answer.left(answer.size() - 2) +
                 Client::number(Client::crcOf(sent + answer.left(answer.size() - 2)), 2);
    QCOMPARE(client.send(sent).toHex(), answer.toHex());
}

void TestRoboClawEmulator::bothAddressesShareALine() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    QVERIFY(client.write(0x80, 22, Client::number(111, 4)));
    QVERIFY(client.write(0x81, 22, Client::number(222, 4)));
    QCOMPARE(client.count(0x80, 0), std::int64_t(111));
    QCOMPARE(client.count(0x81, 0), std::int64_t(222));
    QCOMPARE(client.read(0x82, 24), QByteArray("silent"));
    QCOMPARE(Client(drivetrain, 1).read(0x81, 24), QByteArray("silent"));
    // Several packets in one piece are answered in order.
    QCOMPARE(client.send(QByteArray::fromHex("802F812F")).size(), 8);
}

void TestRoboClawEmulator::linesOfTheirOwn() {
    Drivetrain::Options options;
    options.ownLines = true;
    options.controller[0].anyAddress = options.controller[1].anyAddress = true; // as on USB
    Drivetrain drivetrain(options);
    Client first(drivetrain, 0), second(drivetrain, 1);
    QVERIFY(first.write(0x80, 22, Client::number(111, 4)));
    QCOMPARE(first.count(0x87, 0), std::int64_t(111));
    QCOMPARE(second.count(0x80, 0), std::int64_t(0));
}

void TestRoboClawEmulator::gapsAndDamageAreSilent() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    const QByteArray stop = QByteArray::fromHex("802500000000000000003404");
    QCOMPARE(client.send(stop.left(5)), QByteArray());
    QCOMPARE(client.send(stop.mid(5), 0.009).toHex(), QByteArray("ff"));
    QCOMPARE(client.send(stop.left(5)), QByteArray());
    QCOMPARE(client.send(stop.mid(5), 0.011), QByteArray()); // a gap of more than 10 ms
    QCOMPARE(client.send(stop).toHex(), QByteArray("ff"));
    for (int bit = 0; bit < stop.size() * 8; ++bit) {
        QByteArray damaged = QByteArray::fromHex("8025000003E8FFFFFC188290");
        damaged[bit / 8] = char(damaged[bit / 8] ^ (1 << bit % 8));
        client.send(damaged);
        pass(drivetrain, 0.002);
        QVERIFY2(!drivetrain.isMoving(), qPrintable(QString("bit %1").arg(bit)));
    }
    QVERIFY(drivetrain.controller(0).counts().crcErrors > 70);
}

void TestRoboClawEmulator::everyReadAnswers() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    const QMap<int, int> sizes{{15, 1},  {16, 5},  {17, 5},  {18, 5},  {19, 5}, {24, 2},  {25, 2},
                               {30, 5},  {31, 5},  {47, 2},  {48, 4},  {49, 4}, {55, 16}, {56, 16},
                               {59, 4},  {60, 4},  {63, 28}, {64, 28}, {75, 3}, {78, 8},  {79, 8},
                               {81, 8},  {82, 2},  {83, 2},  {90, 4},  {91, 2}, {99, 2},  {108, 8},
                               {110, 8}, {113, 8}, {135, 8}, {136, 8}, {149, 1}};
    for (auto entry = sizes.begin(); entry != sizes.end(); ++entry) {
        const QByteArray data = client.read(0x80, entry.key());
        QVERIFY2(data.size() == entry.value() && data != "silent",
                 qPrintable(QString("command %1: %2").arg(entry.key()).arg(QString(data))));
    }
    QCOMPARE(client.read(0x80, 21), QByteArray("RoboClaw 2x45A v4.2.8\n\0", 23));
}

void TestRoboClawEmulator::settingsAreKept() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    QVERIFY(client.write(0x80, 14, Client::number(3, 1)));
    QCOMPARE(client.read(0x80, 15), Client::number(3, 1));
    QByteArray dpi, pid; // D, P, I, QPPS are told as P, I, D, QPPS
    for (const int value : {0x4000, 0x18000, 0x8000, 44000})
        dpi += Client::number(value, 4);
    for (const int value : {0x18000, 0x8000, 0x4000, 44000})
        pid += Client::number(value, 4);
    QVERIFY(client.write(0x80, 28, dpi));
    QCOMPARE(client.read(0x80, 55), pid);
    QVERIFY(client.read(0x80, 56) != pid);
    QVERIFY(client.write(0x80, 57, Client::number(0x00960104, 4)));
    QCOMPARE(client.read(0x80, 59), Client::number(0x00960104, 4));
    QVERIFY(client.write(0x80, 253, Client::number(0x05ABCD, 3)));
    QCOMPARE(client.read(0x80, 252, Client::number(5, 1)), Client::number(0xABCD, 2));
    QCOMPARE(client.read(0x80, 252, Client::number(6, 1)), Client::number(0, 2));
    QVERIFY(client.write(0x80, 93, Client::number(0x20, 1)));
    QCOMPARE(client.read(0x80, 91), Client::number(0x0020, 2));
    QVERIFY(!client.write(0x80, 94, Client::number(1, 4))); // not the key
    QVERIFY(client.write(0x80, 95));
    QCOMPARE(client.read(0x80, 55), pid);
    QVERIFY(client.write(0x80, 80));
    QCOMPARE(client.read(0x80, 55), client.read(0x80, 56));
    QCOMPARE(client.read(0x80, 15), Client::number(0, 1));
}

void TestRoboClawEmulator::speedFollowsTheRamp() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    setQpps(client, 150000);
    QVERIFY(client.speeds(0x80, 40000, -20000, 40000));
    pass(drivetrain, 0.5);
    const double half = drivetrain.controller(0).channel(0).speed();
    QVERIFY2(std::abs(half - 20000) < 1500, qPrintable(QString::number(half)));
    pass(drivetrain, 1.5);
    QVERIFY(std::abs(drivetrain.controller(0).channel(0).speed() - 40000) < 400);
    QVERIFY(std::abs(drivetrain.controller(0).channel(1).speed() + 20000) < 200);
    const QByteArray speed = client.read(0x80, 19);
    QVERIFY(std::abs(Client::integer(speed, 0, 4) + 20000) < 200);
    QCOMPARE(int(speed[4]), 1);
    QVERIFY(std::abs(client.count(0x80, 0) - 60000) < 3000); // 0.5 v t + v t
    QVERIFY(client.write(0x80, 37, Client::number(500000, 4) + Client::number(0, 4)));
    pass(drivetrain, 1);
    QVERIFY(drivetrain.controller(0).channel(0).speed() < 151000); // QPPS
    QCOMPARE(drivetrain.controller(0).channel(1).speed(), 0.0);
}

void TestRoboClawEmulator::emergencyDecelerationStopsInTime() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    setQpps(client, 150000);
    const int fast = 60479, slowing = 241916; // 1 m/s and 4 m/s^2 with wheels of 0.1 m
    QVERIFY(client.speeds(0x80, fast, fast, slowing));
    QVERIFY(client.speeds(0x81, fast, fast, slowing));
    pass(drivetrain, 2);
    QVERIFY(client.speeds(0x80, 0, 0, slowing));
    QVERIFY(client.speeds(0x81, 0, 0, slowing));
    double standing = 0;
    for (; drivetrain.isMoving() && standing < 1; standing += 0.001)
        drivetrain.advance(0.001);
    QVERIFY2(standing > 0.24 && standing < 0.25 + 0.05, qPrintable(QString::number(standing)));
}

void TestRoboClawEmulator::dutyTurnsTheMotor() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    QVERIFY(client.write(0x80, 34, Client::number(16384, 2) + Client::number(-16384, 2)));
    pass(drivetrain, 0.5);
    const double expected = 80000 * drivetrain.battery().voltage() / 24;
    QVERIFY(std::abs(drivetrain.controller(0).channel(0).speed() - expected) < 100);
    QVERIFY(std::abs(drivetrain.controller(0).channel(1).speed() + expected) < 100);
    QCOMPARE(client.read(0x80, 48), Client::number(16384, 2) + Client::number(-16384, 2));
    QVERIFY(client.write(0x80, 6, Client::number(64, 1)));
    QVERIFY(client.write(0x80, 4, Client::number(0, 1)));
    pass(drivetrain, 0.5);
    QVERIFY(!drivetrain.isMoving());
}

void TestRoboClawEmulator::distancesAreDriven() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    setQpps(client, 150000);
    const auto move = [&](int speed, int distance, int buffer) {
        return client.write(
            0x80, 41, Client::number(speed, 4) + Client::number(distance, 4) + Client::number(buffer, 1));
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

void TestRoboClawEmulator::silenceStopsTheMotors() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    setQpps(client, 150000);
    QVERIFY(client.write(0x80, 14, Client::number(2, 1)));
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

void TestRoboClawEmulator::encodersWrap() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    QVERIFY(client.write(0x80, 22, Client::number(-5, 4)));
    QCOMPARE(client.read(0x80, 16).left(4).toHex(), QByteArray("fffffffb"));
    setQpps(client, 150000);
    QVERIFY(client.speeds(0x80, 10000, 0, 1000000));
    pass(drivetrain, 0.1);
    QVERIFY(client.count(0x80, 0) > 0);
    QVERIFY(client.write(0x80, 20));
    QVERIFY(client.count(0x80, 0) == 0 && client.count(0x80, 1) == 0);
}

void TestRoboClawEmulator::batteryDrains() {
    Drivetrain::Options options;
    options.battery.capacity_Ah = 0.01;
    Drivetrain drivetrain(options);
    Client client(drivetrain);
    pass(drivetrain, 1);
    const auto before = Client::integer(client.read(0x80, 24), 0, 2);
    QVERIFY(client.write(0x80, 34, Client::number(20000, 2) + Client::number(20000, 2)));
    pass(drivetrain, 20);
    const auto after = Client::integer(client.read(0x80, 24), 0, 2);
    QVERIFY2(after < before - 10, qPrintable(QString("%1 %2").arg(before).arg(after)));
    QVERIFY(drivetrain.battery().charge() < 0.7);
}

void TestRoboClawEmulator::lowBatteryCutsTheMotors() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    setQpps(client, 150000);
    QVERIFY(client.write(0x80, 57, Client::number(210, 2) + Client::number(340, 2)));
    QVERIFY(client.speeds(0x80, 30000, 30000, 300000));
    pass(drivetrain, 0.5);
    drivetrain.battery().setCharge(0);
    pass(drivetrain, 5);
    QVERIFY(Client::integer(client.read(0x80, 90), 0, 4) & 0x4000);
    QVERIFY(drivetrain.controller(0).channel(0).speed() < 1000); // rolled out
    QCOMPARE(drivetrain.controller(0).channel(0).current(), 0.0);
}

void TestRoboClawEmulator::blockedWheelDrawsCurrent() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    setQpps(client, 150000);
    QVERIFY(client.speeds(0x80, 60000, 60000, 300000));
    pass(drivetrain, 1);
    const double free = drivetrain.controller(0).channel(0).current();
    drivetrain.controller(0).channel(0).setBlocked(true);
    pass(drivetrain, 1);
    QCOMPARE(drivetrain.controller(0).channel(0).speed(), 0.0);
    const QByteArray currents = client.read(0x80, 49);
    QVERIFY(Client::integer(currents, 0, 2) > 1500 && free < 2);
    QVERIFY(Client::integer(currents, 2, 2) < 200);
    QVERIFY(client.write(0x80, 133, Client::number(1000, 4) + Client::number(0, 4)));
    pass(drivetrain, 0.1);
    QCOMPARE(Client::integer(client.read(0x80, 49), 0, 2), std::int64_t(1000));
    QVERIFY(Client::integer(client.read(0x80, 90), 0, 4) & 0x10000);
    pass(drivetrain, 30);
    QVERIFY(Client::integer(client.read(0x80, 82), 0, 2) > 255);
}

void TestRoboClawEmulator::brokenEncoderStandsStill() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    setQpps(client, 150000);
    drivetrain.wheel(0).setEncoderBroken(true);
    QVERIFY(client.speeds(0x80, 10000, 10000, 300000));
    pass(drivetrain, 1);
    QCOMPARE(client.count(0x80, 0), std::int64_t(0));
    QVERIFY(client.count(0x80, 1) > 8000);
    QVERIFY(drivetrain.controller(0).channel(0).speed() > 15000); // the control sees no motion and pushes
}

void TestRoboClawEmulator::faultsOfTheLine() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    RoboClawEmulator::Faults &faults = drivetrain.controller(0).faults();
    faults.drop = 0.3;
    int silent = 0;
    for (int i = 0; i < 300; ++i)
        silent += client.read(0x80, 24) == "silent";
    QVERIFY(silent > 60 && silent < 120);
    faults = {};
    faults.corrupt = 0.3;
    int wrong = 0;
    for (int i = 0; i < 300; ++i)
        wrong += client.read(0x80, 24) == "wrong CRC";
    QVERIFY(wrong > 60 && wrong < 120);
    faults = {};
    faults.delay = 0.025;
    QVERIFY(client.read(0x80, 24).size() == 2);
    QCOMPARE(client.delay, 0.025);
    faults = {};
    setQpps(client, 150000);
    QVERIFY(client.speeds(0x80, 10000, 10000, 300000));
    pass(drivetrain, 0.5);
    faults.silent = true;
    QCOMPARE(client.read(0x80, 24), QByteArray("silent"));
    QVERIFY(client.read(0x81, 24).size() == 2);
    pass(drivetrain, 5);
    QVERIFY(drivetrain.controller(0).channel(0).speed() < 1000); // a dead controller drives nothing
}

void TestRoboClawEmulator::statusBitsOfBothWidths() {
    Drivetrain::Options options;
    options.controller[1].status = roboclaw::Dialect::Other;
    Drivetrain drivetrain(options);
    Client client(drivetrain);
    for (const int number : {0, 1})
        drivetrain.controller(number).faults().status = 0x00080001;
    QCOMPARE(client.read(0x80, 90).toHex(), QByteArray("00080001"));
    QCOMPARE(client.read(0x81, 90).toHex(), QByteArray("0804"));
}

void TestRoboClawEmulator::emergencyStopHolds() {
    Drivetrain drivetrain;
    Client client(drivetrain);
    setQpps(client, 150000);
    QVERIFY(client.speeds(0x80, 10000, 10000, 300000));
    pass(drivetrain, 0.5);
    drivetrain.controller(0).faults().status = roboclaw::EmergencyStop;
    pass(drivetrain, 0.3);
    QVERIFY(!drivetrain.isMoving());
    QVERIFY(client.speeds(0x80, 10000, 10000, 300000)); // acknowledged, not obeyed
    pass(drivetrain, 0.3);
    QVERIFY(!drivetrain.isMoving());
}

void TestRoboClawEmulator::wheelsMoveTheBody_data() {
    QTest::addColumn<bool>("mecanum");
    QTest::addColumn<QVector<double>>("wheels"); // front left, front right, rear left, rear right
    QTest::addColumn<QVector<double>>("twist");
    QTest::newRow("forward") << true << QVector<double>{10, 10, 10, 10} << QVector<double>{1, 0, 0};
    QTest::newRow("left") << true << QVector<double>{-10, 10, 10, -10} << QVector<double>{0, 1, 0};
    QTest::newRow("turn") << true << QVector<double>{-10, 10, -10, 10} << QVector<double>{0, 0, 2};
    QTest::newRow("against each other")
        << true << QVector<double>{10, 10, -10, -10} << QVector<double>{0, 0, 0};
    QTest::newRow("differential forward")
        << false << QVector<double>{10, 10, 10, 10} << QVector<double>{1, 0, 0};
    QTest::newRow("differential turn")
        << false << QVector<double>{-10, 10, -10, 10} << QVector<double>{0, 0, 4};
}

void TestRoboClawEmulator::wheelsMoveTheBody() {
    QFETCH(bool, mecanum);
    QFETCH(QVector<double>, wheels);
    QFETCH(QVector<double>, twist);
    WheelBase base;
    base.kind = mecanum ? WheelBase::Kind::Mecanum : WheelBase::Kind::Differential;
    const Twist found = base.twistOf({wheels[0], wheels[1], wheels[2], wheels[3]});
    QVERIFY(std::abs(found.vx - twist[0]) < 1e-12);
    QVERIFY(std::abs(found.vy - twist[1]) < 1e-12);
    QVERIFY(std::abs(found.omega - twist[2]) < 1e-12);
}

void TestRoboClawEmulator::arcsAreExact() {
    const auto pose = RobotBody().move({0, 0, 0.3}, {0.5, -0.2, 0.7}, 2);
    QVERIFY(std::abs(pose.x - 0.807012141) < 1e-9 && std::abs(pose.y - 0.575516530) < 1e-9);
    QVERIFY(std::abs(pose.theta - 1.7) < 1e-12);
}

void TestRoboClawEmulator::wallsHoldTheRobot() {
    RobotBody body({{{2, -5}, {2, 5}}}, 0.3);
    vectorlib::Pose2D pose{0, 0, 0};
    for (int i = 0; i < 4000; ++i)
        pose = body.move(pose, {1, 0.1, 0}, 0.001);
    QVERIFY(std::abs(pose.x - 1.7) < 1e-9);
    QVERIFY(std::abs(pose.y - 0.4) < 1e-9); // it slides along the wall
    QVERIFY(body.isTouching());
    pose = body.move(pose, {-1, 0, 0}, 0.001);
    QVERIFY(!body.isTouching() && pose.x < 1.7);
}

void TestRoboClawEmulator::cornersHoldTheRobot() {
    RobotBody body({{{0, 0}, {5, 0}}, {{0, 1}, {0, 0}}, {{5, 0.7}, {0, 1}}},
                   0.3); // ever narrower to the right
    vectorlib::Pose2D pose{0.5, 0.5, 0};
    for (const Twist &twist :
         {Twist{1, 0, 0}, Twist{1, 0.5, 0}, Twist{1, -0.5, 0}, Twist{0, 1, 0}, Twist{-1, 1, 0}}) {
        for (int i = 0; i < 5000; ++i) {
            pose = body.move(pose, twist, 0.001);
            const vectorlib::Vector2D<double> at(pose.x, pose.y);
            QVERIFY(at.y >= 0.3 - 1e-9 && at.x >= 0.3 - 1e-9);
            QVERIFY((vectorlib::LineSegment2D<double>({5, 0.7}, {0, 1}).distance(at) >= 0.3 - 1e-9));
        }
    }
}

void TestRoboClawEmulator::slipShortensTheWay() {
    Drivetrain::Options options;
    options.slip = 0.2;
    Drivetrain drivetrain(options);
    Client client(drivetrain);
    setQpps(client, 150000);
    QVERIFY(client.speeds(0x80, 30000, 30000, 300000));
    QVERIFY(client.speeds(0x81, 30000, 30000, 300000));
    pass(drivetrain, 2);
    const double rim = 30000 / 38000.0 * 2 * M_PI * 0.1;
    QVERIFY(std::abs(drivetrain.advance(0.001).vx - 0.8 * rim) < 0.01 * rim);
}

QTEST_GUILESS_MAIN(TestRoboClawEmulator)
#include "TestRoboClawEmulator.moc"
