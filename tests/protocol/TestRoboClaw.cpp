#include "protocol/roboclaw/Crc16.h"
#include "protocol/roboclaw/RequestParser.h"
#include "protocol/roboclaw/Status.h"

#include <QtTest>

#include <cstring>
#include <random>

using namespace hermes::roboclaw;

namespace {

QByteArray text(const Bytes &bytes) {
    return QByteArray(reinterpret_cast<const char *>(bytes.data()), int(bytes.size())).toHex(' ').toUpper();
}

ReplyParser::Result feed(ReplyParser &parser, const QByteArray &bytes) {
    auto result = ReplyParser::Result::Incomplete;
    for (const char byte : bytes) {
        if (result != ReplyParser::Result::Incomplete)
            qFatal("the answer ended before its last byte");
        result = parser.feed(std::uint8_t(byte));
    }
    return result;
}

std::vector<std::uint8_t> everyCommand() {
    std::vector<std::uint8_t> commands;
    for (int command = 0; command < 256; ++command) {
        if (layoutOf(std::uint8_t(command)))
            commands.push_back(std::uint8_t(command));
    }
    return commands;
}

std::int64_t anyValue(char field, std::mt19937 &random) {
    const std::uint32_t raw = random() >> (random() % 3 * 8);
    return field == 'B'   ? raw & 0xFF
           : field == 'H' ? raw & 0xFFFF
           : field == 'h' ? std::int16_t(raw)
           : field == 'i' ? std::int32_t(raw)
                          : std::int64_t(raw);
}

Values anyValues(std::string_view fields, std::mt19937 &random) {
    Values values;
    for (const char field : fields)
        values.push(anyValue(field, random));
    return values;
}

bool same(const Values &a, const Values &b) {
    bool equal = a.size() == b.size();
    for (std::size_t i = 0; equal && i < a.size(); ++i)
        equal = a[i] == b[i];
    return equal;
}

} // namespace

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
    void versionIsText();
    void acknowledgementIsOneByte();
    void statusOfBothWidths();
    void speedsHaveTheirSign_data();
    void speedsHaveTheirSign();
    void everyCommandPassesBothWays();
    void everyFlippedBitIsSeen();
    void deviceDropsPartsAndStrangers();
    void anyBytesAreBorne();
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
    QTest::newRow("no command") << 0x80 << 72 << Values{};
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

void TestRoboClaw::versionIsText() {
    const auto request = Request::make(0x80, Command::ReadVersion);
    const auto parse = [&](QByteArray bytes) {
        ReplyParser parser;
        parser.begin(*request);
        const auto result = feed(parser, bytes);
        return std::make_pair(result, QByteArray(parser.reply().text.data()));
    };
    const auto bytesOf = [](const Bytes &b) {
        return QByteArray(reinterpret_cast<const char *>(b.data()), int(b.size()));
    };
    const QByteArray answer = bytesOf(encodeText(*request, "RoboClaw 10.2A v4.1.11"));
    QCOMPARE(answer.size(), 22 + 4);
    QCOMPARE(answer.mid(22, 2), QByteArray("\n\0", 2));
    QCOMPARE(parse(answer), std::make_pair(ReplyParser::Result::Done, QByteArray("RoboClaw 10.2A v4.1.11")));
    QByteArray damaged = answer;
    damaged[3] = 'x';
    QCOMPARE(parse(damaged).first, ReplyParser::Result::BadCrc);
    QCOMPARE(parse(QByteArray(int(maxText) + 2, 'x')).first, ReplyParser::Result::Unexpected);
    QCOMPARE(parse(QByteArray("a\0\0\0", 4)).first, ReplyParser::Result::Unexpected); // no line feed
    QCOMPARE(parse(bytesOf(encodeText(*request, ""))).first, ReplyParser::Result::Done);
    const QByteArray longest = bytesOf(encodeText(*request, std::string(100, 'v')));
    QCOMPARE(parse(longest), std::make_pair(ReplyParser::Result::Done, QByteArray(46, 'v')));
}

void TestRoboClaw::acknowledgementIsOneByte() {
    ReplyParser parser;
    QCOMPARE(parser.feed(0xFF), ReplyParser::Result::Unexpected); // nothing was asked
    parser.begin(*Request::make(0x80, Command::Speed, {0, 0}));
    QCOMPARE(parser.silence(), ReplyParser::Result::Incomplete);
    QCOMPARE(parser.feed(0xFF), ReplyParser::Result::Done);
    parser.begin(*Request::make(0x80, Command::Speed, {0, 0}));
    QCOMPARE(parser.feed(0xFE), ReplyParser::Result::Unexpected);
}

void TestRoboClaw::statusOfBothWidths() {
    const auto request = Request::make(0x80, Command::ReadStatus);
    ReplyParser parser;
    parser.begin(*request);
    QCOMPARE(feed(parser, QByteArray::fromHex("08048D1A")), ReplyParser::Result::Incomplete);
    QCOMPARE(parser.silence(), ReplyParser::Result::Done);
    QCOMPARE(parser.dialect(), Dialect::Other);
    QCOMPARE(statusOf(parser.reply(), parser.dialect()),
             std::uint32_t(EmergencyStop | MainVoltageLowWarning));
    parser.begin(*request);
    QCOMPARE(feed(parser, QByteArray::fromHex("08048D1B")), ReplyParser::Result::Incomplete);
    QCOMPARE(parser.silence(), ReplyParser::Result::BadCrc);
    parser.begin(*request);
    QCOMPARE(feed(parser, QByteArray::fromHex("0008")), ReplyParser::Result::Incomplete);
    QCOMPARE(parser.silence(), ReplyParser::Result::Incomplete); // a part of either
    QCOMPARE(feed(parser, QByteArray::fromHex("00013E3C")), ReplyParser::Result::Done);
    QCOMPARE(parser.dialect(), Dialect::Usual);
    QCOMPARE(statusOf(parser.reply(), parser.dialect()), std::uint32_t(0x00080001));
    QCOMPARE(int(oldStatusOf(0x00080001)), 0x0804);
    QCOMPARE(statusText(MainVoltageLowWarning), "main voltage low");
    QCOMPARE(statusText(0x80000000), "reserved bit");
    const auto old = encodeReply(*request, {0x0804}, Dialect::Other);
    QCOMPARE(text(*old), QByteArray("08 04 8D 1A"));
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

void TestRoboClaw::everyCommandPassesBothWays() {
    std::mt19937 random(1);
    QCOMPARE(int(everyCommand().size()), 101);
    for (const std::uint8_t command : everyCommand()) {
        for (int round = 0; round < 20; ++round) {
            const Layout &layout = *layoutOf(command);
            const auto dialect = Dialect(round % 2);
            const auto fields = dialect == Dialect::Usual ? layout.fields : layout.otherFields;
            const Values values = anyValues(layout.isRead ? layout.arguments : fields, random);
            const auto request = Request::make(std::uint8_t(0x80 + round % 8), Command(command), values);
            QVERIFY(request);
            RequestParser device(dialect);
            auto heard = RequestParser::Result::Incomplete;
            for (std::size_t i = 0; i < request->bytes.size(); ++i)
                heard = device.feed(request->bytes[i]);
            QCOMPARE(heard, RequestParser::Result::Done);
            QVERIFY(same(device.request().values, values));
            if (!layout.isRead || fields == "s")
                continue;
            const Values told = anyValues(fields, random);
            const auto answer = encodeReply(device.request(), told, dialect);
            ReplyParser parser;
            parser.begin(*request);
            auto result = ReplyParser::Result::Incomplete;
            for (std::size_t i = 0; i < answer->size(); ++i)
                result = parser.feed((*answer)[i]);
            if (result == ReplyParser::Result::Incomplete)
                result = parser.silence();
            QCOMPARE(result, ReplyParser::Result::Done);
            const bool differs = layout.fields != layout.otherFields;
            QCOMPARE(parser.dialect(), differs ? dialect : Dialect::Usual);
            QVERIFY(same(parser.reply().values, told));
        }
    }
}

void TestRoboClaw::everyFlippedBitIsSeen() {
    const auto write = Request::make(0x80, Command::SpeedAccel, {12000, 6000, -6000});
    for (std::size_t bit = 0; bit < write->bytes.size() * 8; ++bit) {
        RequestParser device;
        for (std::size_t i = 0; i < write->bytes.size(); ++i) {
            const std::uint8_t byte = std::uint8_t(write->bytes[i] ^ (bit / 8 == i ? 1 << bit % 8 : 0));
            if (device.feed(byte) == RequestParser::Result::Done)
                QVERIFY2(device.request().isRead(), qPrintable(QString("bit %1 was not seen").arg(bit)));
        }
    }
    const auto read = Request::make(0x80, Command::ReadEncoders);
    const auto answer = encodeReply(*read, {1000, 2000});
    for (std::size_t bit = 0; bit < answer->size() * 8; ++bit) {
        ReplyParser parser;
        parser.begin(*read);
        auto result = ReplyParser::Result::Incomplete;
        for (std::size_t i = 0; i < answer->size(); ++i)
            result = parser.feed(std::uint8_t((*answer)[i] ^ (bit / 8 == i ? 1 << bit % 8 : 0)));
        QCOMPARE(result, ReplyParser::Result::BadCrc);
    }
}

void TestRoboClaw::deviceDropsPartsAndStrangers() {
    RequestParser device;
    QCOMPARE(device.feed(0x12), RequestParser::Result::Unknown);
    QCOMPARE(device.feed(0x80), RequestParser::Result::Incomplete);
    QCOMPARE(device.feed(72), RequestParser::Result::Unknown);
    QCOMPARE(device.feed(0x80), RequestParser::Result::Incomplete);
    QCOMPARE(device.feed(37), RequestParser::Result::Incomplete);
    QCOMPARE(device.pending(), std::size_t(2));
    device.silence();
    device.feed(0x81);
    QCOMPARE(device.feed(90), RequestParser::Result::Done);
    QCOMPARE(int(device.request().address), 0x81);
    for (const int byte : {0x80, 0x14, 0x49})
        QCOMPARE(device.feed(std::uint8_t(byte)), RequestParser::Result::Incomplete);
    QCOMPARE(device.feed(0x2E), RequestParser::Result::BadCrc);
}

void TestRoboClaw::anyBytesAreBorne() {
    std::mt19937 random(3);
    RequestParser device;
    ReplyParser parser;
    const auto commands = everyCommand();
    for (int i = 0; i < 300000; ++i) {
        if (device.feed(std::uint8_t(random())) == RequestParser::Result::Done)
            QVERIFY(layoutOf(std::uint8_t(device.request().command)));
        QVERIFY(device.pending() <= 37);
        if (i % 60 == 0) {
            const auto command = Command(commands[random() % commands.size()]);
            const auto &layout = *layoutOf(std::uint8_t(command));
            parser.begin(*Request::make(0x80, command,
                                        anyValues(layout.isRead ? layout.arguments : layout.fields, random)));
        }
        if (parser.feed(std::uint8_t(random() % (i % 2 ? 256 : 11))) == ReplyParser::Result::Done)
            parser.begin(*Request::make(0x80, Command::ReadVersion));
    }
}

QTEST_GUILESS_MAIN(TestRoboClaw)
#include "TestRoboClaw.moc"
