// Requests and answers as bytes.
#include "RoboClawBytes.h"
#include "protocol/roboclaw/Crc16.h"
#include "protocol/roboclaw/RequestParser.h"
#include "protocol/roboclaw/Status.h"

#include <QtTest>

using namespace hermes::roboclaw;

Q_DECLARE_METATYPE(hermes::roboclaw::Values)
Q_DECLARE_METATYPE(hermes::roboclaw::Command)

/// The byte strings were computed apart from this code (packet serial, polynomial 0x1021).
class TestRoboClaw : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void crcHasItsCheckValue();
    void writesAreEncoded_data();
    void writesAreEncoded();
    void readsAreEncodedAndAnswered_data();
    void readsAreEncodedAndAnswered();
    void layoutsHaveTheirSizes_data();
    void layoutsHaveTheirSizes();
    void refusesWhatDoesNotFit_data();
    void refusesWhatDoesNotFit();
    void speedsHaveTheirSign_data();
    void speedsHaveTheirSign();
};

void TestRoboClaw::crcHasItsCheckValue() {
    QCOMPARE(int(crc16(reinterpret_cast<const std::uint8_t *>("123456789"), 9)), 0x31C3);
}

void TestRoboClaw::writesAreEncoded_data() {
    QTest::addColumn<int>("address");
    QTest::addColumn<Command>("command");
    QTest::addColumn<Values>("values");
    QTest::addColumn<QByteArray>("bytes");
    const auto row = [](const char *name, int address, Command command, const Values &values,
                        const char *bytes) {
        QTest::newRow(name) << address << command << values << QByteArray(bytes);
    };
    row("one speed", 0x80, Command::SpeedM1, {1000}, "80 23 00 00 03 E8 1B 33");
    row("both speeds", 0x80, Command::Speed, {1000, -1000}, "80 25 00 00 03 E8 FF FF FC 18 82 90");
    row("second controller", 0x81, Command::Speed, {-2500, 2500}, "81 25 FF FF F6 3C 00 00 09 C4 D2 B7");
    row("stop", 0x80, Command::Speed, {0, 0}, "80 25 00 00 00 00 00 00 00 00 34 04");
    row("no duty", 0x80, Command::Duty, {0, 0}, "80 22 00 00 00 00 98 17");
    row("one duty", 0x80, Command::DutyM1, {-16384}, "80 20 C0 00 4D AA");
    row("no data", 0x80, Command::ResetEncoders, {}, "80 14 49 2D");
    row("time-out", 0x80, Command::SetSerialTimeout, {5}, "80 0E 05 48 F0");
    row("PID", 0x80, Command::SetVelocityPidM1, {0x4000, 0x10000, 0x8000, 44000},
        "80 1C 00 00 40 00 00 01 00 00 00 00 80 00 00 00 AB E0 26 FA");
    row("acceleration", 0x80, Command::SpeedAccel, {12000, 6000, -6000},
        "80 28 00 00 2E E0 00 00 17 70 FF FF E8 90 67 03");
    row("key", 0x80, Command::WriteSettings, {writeSettingsKey}, "80 5E E2 2E AB 7A E4 A6");
}

void TestRoboClaw::writesAreEncoded() {
    QFETCH(int, address);
    QFETCH(Command, command);
    QFETCH(Values, values);
    QFETCH(QByteArray, bytes);
    const auto request = Request::make(std::uint8_t(address), command, values);
    QVERIFY(request);
    QCOMPARE(text(request->bytes), bytes);
    RequestParser device;
    for (std::size_t i = 0; i + 1 < request->bytes.size(); ++i)
        QCOMPARE(device.feed(request->bytes[i]), RequestParser::Result::Incomplete);
    QCOMPARE(device.feed(request->bytes[request->bytes.size() - 1]), RequestParser::Result::Done);
    QCOMPARE(int(device.request().address), address);
    QCOMPARE(device.request().command, command);
    QVERIFY(same(device.request().values, values));
}

void TestRoboClaw::readsAreEncodedAndAnswered_data() {
    QTest::addColumn<Command>("command");
    QTest::addColumn<Values>("values");
    QTest::addColumn<QByteArray>("sent");
    QTest::addColumn<QByteArray>("answer");
    const auto row = [](const char *name, Command command, const Values &values, const char *sent,
                        const char *answer) {
        QTest::newRow(name) << command << values << QByteArray(sent) << QByteArray(answer);
    };
    row("battery", Command::ReadMainBattery, {240}, "80 18", "00 F0 D8 E5");
    row("encoder", Command::ReadEncoderM1, {1000, 0}, "80 10", "00 00 03 E8 00 71 36");
    row("speed", Command::ReadSpeedM1, {-1000, 1}, "80 12", "FF FF FC 18 01 27 F9");
    row("counts", Command::ReadEncoders, {1000, 0xFFFFFC18}, "80 4E", "00 00 03 E8 FF FF FC 18 7E 0E");
    row("currents", Command::ReadCurrents, {150, -20}, "80 31", "00 96 FF EC 87 5B");
    row("buffers", Command::ReadBuffers, {0x80, 0x80}, "80 2F", "80 80 FD DF");
    row("temperature", Command::ReadTemperature, {305}, "80 52", "01 31 F8 D5");
    row("status", Command::ReadStatus, {EmergencyStop | MainVoltageLowWarning}, "80 5A", "00 08 00 01 3E 3C");
    row("PID", Command::ReadVelocityPidM1, {0x10000, 0x8000, 0x4000, 44000}, "80 37",
        "00 01 00 00 00 00 80 00 00 00 40 00 00 00 AB E0 AB C0");
}

void TestRoboClaw::readsAreEncodedAndAnswered() {
    QFETCH(Command, command);
    QFETCH(Values, values);
    QFETCH(QByteArray, sent);
    QFETCH(QByteArray, answer);
    const auto request = Request::make(0x80, command);
    QVERIFY(request);
    QCOMPARE(text(request->bytes), sent);
    const auto encoded = encodeReply(*request, values);
    QVERIFY(encoded);
    QCOMPARE(text(*encoded), answer);
    ReplyParser parser;
    parser.begin(*request);
    QCOMPARE(feed(parser, QByteArray::fromHex(answer)), ReplyParser::Result::Done);
    QVERIFY(same(parser.reply().values, values));
}

void TestRoboClaw::layoutsHaveTheirSizes_data() {
    QTest::addColumn<QVector<int>>("commands");
    QTest::addColumn<bool>("isRead");
    QTest::addColumn<int>("size");
    QTest::newRow("W 1") << QVector<int>{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,
                                         10, 11, 12, 13, 14, 26, 27, 92, 93, 148}
                         << false << 1;
    QTest::newRow("W 0") << QVector<int>{20, 80, 95} << false << 0;
    QTest::newRow("W 2") << QVector<int>{32, 33, 70, 71, 98} << false << 2;
    QTest::newRow("W 3") << QVector<int>{74, 253} << false << 3;
    QTest::newRow("W 4") << QVector<int>{22, 23, 34, 35, 36, 57, 58, 68, 69, 94} << false << 4;
    QTest::newRow("W 6") << QVector<int>{52, 53} << false << 6;
    QTest::newRow("W 8") << QVector<int>{37, 38, 39, 109, 112, 133, 134} << false << 8;
    QTest::newRow("W 9") << QVector<int>{41, 42} << false << 9;
    QTest::newRow("W 12") << QVector<int>{40, 54} << false << 12;
    QTest::newRow("W 13") << QVector<int>{44, 45} << false << 13;
    QTest::newRow("W 16") << QVector<int>{28, 29, 50} << false << 16;
    QTest::newRow("W 17") << QVector<int>{43, 65, 66} << false << 17;
    QTest::newRow("W 21") << QVector<int>{46} << false << 21;
    QTest::newRow("W 25") << QVector<int>{51} << false << 25;
    QTest::newRow("W 28") << QVector<int>{61, 62} << false << 28;
    QTest::newRow("W 33") << QVector<int>{67} << false << 33;
    QTest::newRow("R 1") << QVector<int>{15, 149} << true << 1;
    QTest::newRow("R 2") << QVector<int>{24, 25, 47, 82, 83, 91, 99, 252} << true << 2;
    QTest::newRow("R 3") << QVector<int>{75} << true << 3;
    QTest::newRow("R 4") << QVector<int>{48, 49, 59, 60, 90} << true << 4;
    QTest::newRow("R 5") << QVector<int>{16, 17, 18, 19, 30, 31} << true << 5;
    QTest::newRow("R 8") << QVector<int>{78, 79, 81, 108, 110, 113, 135, 136} << true << 8;
    QTest::newRow("R 16") << QVector<int>{55, 56} << true << 16;
    QTest::newRow("R 28") << QVector<int>{63, 64} << true << 28;
}

void TestRoboClaw::layoutsHaveTheirSizes() {
    QFETCH(QVector<int>, commands);
    for (const int command : commands) {
        const Layout *layout = layoutOf(std::uint8_t(command));
        QVERIFY2(layout, qPrintable(QString("command %1").arg(command)));
        QCOMPARE(int(layout->command), command);
        QTEST(layout->isRead, "isRead");
        QTEST(int(sizeOf(layout->fields)), "size");
    }
}

void TestRoboClaw::refusesWhatDoesNotFit_data() {
    QTest::addColumn<int>("address");
    QTest::addColumn<int>("command");
    QTest::addColumn<Values>("values");
    QTest::newRow("address below") << 0x7F << 37 << Values{0, 0};
    QTest::newRow("address above") << 0x88 << 37 << Values{0, 0};
    QTest::newRow("no command") << 0x80 << 73 << Values{};
    QTest::newRow("too few") << 0x80 << 37 << Values{0};
    QTest::newRow("too many") << 0x80 << 37 << Values{0, 0, 0};
    QTest::newRow("far too many") << 0x80 << 37 << Values{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    QTest::newRow("speed too large") << 0x80 << 35 << Values{std::int64_t(INT32_MAX) + 1};
    QTest::newRow("speed too small") << 0x80 << 35 << Values{std::int64_t(INT32_MIN) - 1};
    QTest::newRow("negative acceleration") << 0x80 << 38 << Values{-1, 0};
    QTest::newRow("duty too large") << 0x80 << 32 << Values{32768};
    QTest::newRow("byte too large") << 0x80 << 14 << Values{256};
    QTest::newRow("read with a value") << 0x80 << 90 << Values{1};
    QTest::newRow("EEPROM without address") << 0x80 << 252 << Values{};
}

void TestRoboClaw::refusesWhatDoesNotFit() {
    QFETCH(int, address);
    QFETCH(int, command);
    QFETCH(Values, values);
    QVERIFY(!Request::make(std::uint8_t(address), Command(command), values));
}

void TestRoboClaw::speedsHaveTheirSign_data() {
    QTest::addColumn<Values>("values");
    QTest::addColumn<int>("speed");
    QTest::newRow("forward") << Values{1000, 0} << 1000;
    QTest::newRow("two's complement") << Values{-1000, 1} << -1000;
    QTest::newRow("magnitude and direction") << Values{1000, 1} << -1000;
    QTest::newRow("negative without direction") << Values{-1000, 0} << -1000;
    QTest::newRow("smallest") << Values{INT32_MIN, 1} << INT32_MIN;
}

void TestRoboClaw::speedsHaveTheirSign() {
    QFETCH(Values, values);
    QTEST(signedSpeed(Reply{values, {}}), "speed");
}

QTEST_GUILESS_MAIN(TestRoboClaw)
#include "TestRoboClaw.moc"
