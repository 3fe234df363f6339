// What is said to VESCs, an OpenCR and a Roboteq, byte for byte, and what is made of their answers: whole,
// cut, damaged, of the wrong size, of somebody else. The packets are those of their makers' sources, with
// their checksums.
#include "protocol/drive/Crc16.h"
#include "protocol/drive/OpenCrDevice.h"
#include "protocol/drive/RoboteqDevice.h"
#include "protocol/drive/VescDevice.h"

#include <memory>

using namespace hermes::drive;
using Kind = Command::Kind;
using Result = ReplyReader::Result;
using Speeds = std::array<std::int32_t, 2>;

Q_DECLARE_METATYPE(hermes::drive::Command)
Q_DECLARE_METATYPE(hermes::drive::ReplyReader::Result)

namespace {

constexpr int secondId = 10;

/// A TurtleBot 3 Burger where wheels matter, and a full speed of 1000 counts/s.
DeviceSettings measures() {
    DeviceSettings settings;
    settings.pid.qpps = 1000;
    settings.countsPerTurn = 4096;
    settings.wheelRadius_m = 0.033;
    settings.halfTrack_m = 0.08;
    return settings;
}

std::unique_ptr<MotorDevice> made(const QString &kind, const DeviceSettings &settings = measures()) {
    std::unique_ptr<MotorDevice> device;
    if (kind.startsWith("vesc"))
        device = std::make_unique<VescDevice>(kind == "vesc" ? secondId : VescDevice::alone);
    else if (kind == "opencr")
        device = std::make_unique<OpenCrDevice>();
    else
        device = std::make_unique<RoboteqDevice>();
    device->configure(settings);
    return device;
}

QByteArray hex(const Bytes &bytes) {
    return QByteArray(reinterpret_cast<const char *>(bytes.data()), int(bytes.size())).toHex(' ').toUpper();
}

template <std::uint16_t polynomial>
std::uint16_t crcOf(const QByteArray &bytes) {
    return crc16<polynomial>(reinterpret_cast<const std::uint8_t *>(bytes.data()), std::size_t(bytes.size()));
}

/// Answers of a VESC, from the hexadecimal text of what is in them.
QByteArray vesc(const char *payload) {
    const QByteArray bytes = QByteArray::fromHex(payload);
    const std::uint16_t crc = crcOf<0x1021>(bytes);
    const QByteArray size = bytes.size() < 256
                                ? QByteArray("\x02", 1) + char(bytes.size())
                                : QByteArray("\x03", 1) + char(bytes.size() >> 8) + char(bytes.size());
    return size + bytes + char(crc >> 8) + char(crc) + '\x03';
}

/// The same of an OpenCR: error and what was read.
QByteArray opencr(const char *content) {
    const QByteArray bytes = QByteArray::fromHex(content);
    const QByteArray packet =
        QByteArray::fromHex("FFFFFD00C8") + char(bytes.size() + 3) + QByteArray("\x00\x55", 2) + bytes;
    const std::uint16_t crc = crcOf<0x8005>(packet);
    return packet + char(crc) + char(crc >> 8);
}

/// The app configuration of a VESC with this id, time-out and brake current, and 600 bytes more.
QByteArray configuration(const char *beginning) {
    return vesc(QByteArray("11DEADBEEF") + beginning + QByteArray(1200, '0'));
}

/// The result of the last byte that is taken.
Result feed(MotorDevice &device, const QByteArray &answer) {
    Result result = Result::Incomplete;
    for (const char byte : answer)
        if (result == Result::Incomplete)
            result = device.reader().feed(std::uint8_t(byte));
    return result;
}

Result ask(MotorDevice &device, const Command &command, const QByteArray &answer) {
    device.reader().begin(device.bytes(command));
    return feed(device, answer);
}

const QByteArray bothIds = vesc("320002000001") + vesc("32000200000A");
const QByteArray bothCounts = vesc("3200022000FFFFFB2E0A") + vesc("32000220000000000701");
const QByteArray bothMeasures =
    vesc("320002814501900000007B01F400F80001") + vesc("320002814500FAFFFFFF38FE0C00F2040A");
const QByteArray okay = opencr("00");
const QByteArray positions = opencr("0001000000FFFFFD"
                                    "FDFF"); // stuffed: 1 and -131073

} // namespace

class TestMotorDevices : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void says_data() {
        const Rows<QString, Command, QByteArray> row("kind", "command", "bytes");
        const QByteArray ids = "02 05 32 00 02 00 00 26 0D 03 02 07 22 0A 32 00 02 00 00 AE 1A 03";
        row("vesc speeds", "vesc", {Kind::SetSpeeds, 0, {300, -300}},
            "02 05 08 00 00 0B B8 F8 04 03 02 07 22 0A 08 FF FF F4 48 18 33 03 " + ids);
        row("vesc brakes below the least speed", "vesc", {Kind::SetSpeeds, 0, {0, 89}},
            "02 05 07 00 00 13 88 21 74 03 02 07 22 0A 07 00 00 13 88 A9 63 03 " + ids);
        row("vesc without power", "vesc", {Kind::CutPower, 0, {300, 300}},
            "02 05 07 00 00 13 88 21 74 03 02 07 22 0A 07 00 00 13 88 A9 63 03 " + ids);
        row("vesc steers", "vesc alone", {Kind::SetSpeeds, 0, {300, 0}, 1, 0.5},
            "02 05 08 00 00 0B B8 F8 04 03 02 03 0C 01 F4 E9 CB 03 02 05 32 00 02 00 00 26 0D 03");
        row("vesc beyond its numbers", "vesc alone", {Kind::SetSpeeds, 0, {INT32_MIN, 0}, 1, std::nan("")},
            "02 05 08 C4 65 36 00 A4 D0 03 02 05 32 00 02 00 00 26 0D 03");
        row("vesc firmware", "vesc", {Kind::SetUp, 0}, "02 01 00 00 00 03");
        row("vesc app configuration", "vesc", {Kind::SetUp, 2}, "02 01 11 02 10 03");
        row("opencr speeds", "opencr", {Kind::SetSpeeds, 0, {1185, 2766}}, // 0.10 m/s, 0.50 rad/s
            "FF FF FD 00 C8 1D 00 03 96 00 0A 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 32 00 "
            "00 00 4D "
            "37 FF FF FD 00 C8 06 00 03 13 00 01 37 A7");
        row("opencr positions", "opencr", {Kind::ReadEncoders}, "FF FF FD 00 C8 07 00 02 88 00 08 00 83 5F");
        row("roboteq speeds", "roboteq", {Kind::SetSpeeds, 0, {500, -2000}},
            QByteArray("!G 1 500\r!G 2 -1000\r").toHex(' ').toUpper());
        row("roboteq without power", "roboteq", {Kind::CutPower, 0, {500, 500}},
            QByteArray("\r!G 1 0\r!G 2 0\r").toHex(' ').toUpper());
        row("roboteq time-out", "roboteq", {Kind::SetUp, 1}, QByteArray("^RWD 200\r").toHex(' ').toUpper());
    }

    void says() {
        FETCH(QString, kind, Command, command, QByteArray, bytes);
        QCOMPARE(hex(made(kind)->bytes(command)), bytes);
    }

    void answers_data() {
        const Rows<QString, Command, QByteArray> row("kind", "command", "answer");
        row("vesc set-point", "vesc", {Kind::SetSpeeds}, bothIds);
        row("vesc counts", "vesc", {Kind::ReadEncoders}, bothCounts);
        row("vesc measures", "vesc", {Kind::ReadSlow}, bothMeasures);
        row("vesc app configuration", "vesc", {Kind::SetUp, 2}, configuration("01000000C80000000000"));
        row("opencr set-point", "opencr", {Kind::SetSpeeds}, okay + okay);
        row("opencr positions", "opencr", {Kind::ReadEncoders}, positions);
    }

    // Whole they are taken; cut they are waited for; with any bit damaged they are no answer.
    void answers() {
        FETCH(QString, kind, Command, command, QByteArray, answer);
        const auto device = made(kind);
        QCOMPARE(ask(*device, command, answer), Result::Done);
        for (int size = 0; size < answer.size(); ++size)
            QCOMPARE(ask(*device, command, answer.left(size)), Result::Incomplete);
        QCOMPARE(device->reader().silence(), Result::Incomplete);
        for (int bit = 0; bit < 8 * answer.size(); ++bit) {
            QByteArray damaged = answer;
            damaged[bit / 8] = char(damaged[bit / 8] ^ 1 << bit % 8);
            QVERIFY2(ask(*device, command, damaged) != Result::Done, damaged.toHex(' ').constData());
        }
        QCOMPARE(ask(*device, command, answer), Result::Done);
    }

    void noAnswers_data() {
        const Rows<QString, Command, QByteArray> row("kind", "command", "answer");
        row("vesc: twice the same", "vesc", {Kind::SetSpeeds}, vesc("32000200000A") + vesc("32000200000A"));
        row("vesc: other values", "vesc", {Kind::SetSpeeds}, bothCounts);
        row("vesc: too few", "vesc", {Kind::ReadEncoders}, vesc("3200022000FFFFFB0A"));
        row("vesc: another command", "vesc", {Kind::ReadEncoders},
            vesc("040002200000000000"
                 "0A"));
        row("vesc: nothing in it", "vesc", {Kind::ReadEncoders}, QByteArray::fromHex("0200000003"));
        row("vesc: without end", "vesc", {Kind::ReadEncoders}, QByteArray::fromHex("03FFFF"));
        row("vesc: cut app configuration", "vesc", {Kind::SetUp, 2}, vesc("11DEADBEEF01000000C8"));
        row("opencr: an error", "opencr", {Kind::SetSpeeds}, opencr("04") + okay);
        row("opencr: too few", "opencr", {Kind::ReadEncoders}, opencr("0001020304"));
        row("opencr: too many", "opencr", {Kind::ReadEncoders},
            opencr("0001020304050607"
                   "0809"));
        row("opencr: another device", "opencr", {Kind::ReadEncoders}, QByteArray::fromHex("FFFFFD0001"));
        row("opencr: nothing in it", "opencr", {Kind::ReadEncoders}, QByteArray::fromHex("FFFFFD00C80300"));
        row("opencr: without end", "opencr", {Kind::ReadEncoders}, QByteArray::fromHex("FFFFFD00C8FF7F"));
        for (const char *text : {"-\r", "+\r-\r", "C=1:2\r"})
            row(text, "roboteq", {Kind::SetSpeeds}, text);
        for (const char *text : {"C=1\r", "C=1:2:3\r", "C=1 2\r", "C=12-3\r", "C=1:4294967296\r", "A=1:2\r",
                                 "C=:2\r", "+\r", "C=a:b\r", "?c\r"})
            row(text, "roboteq", {Kind::ReadEncoders}, text);
        row("roboteq: without end", "roboteq", {Kind::ReadEncoders}, QByteArray(200, '1'));
        row("roboteq: no name", "roboteq", {Kind::SetUp, 0}, "FID=\r");
    }

    void noAnswers() {
        FETCH(QString, kind, Command, command, QByteArray, answer);
        QCOMPARE(ask(*made(kind), command, answer), Result::Unexpected);
    }

    void anEchoIsNoAnswer() {
        const auto roboteq = made("roboteq");
        QCOMPARE(ask(*roboteq, {Kind::SetSpeeds, 0, {500, 0}}, "!G 1 500\r!G 2 0\r+\r"), Result::Incomplete);
        QCOMPARE(feed(*roboteq, "\n+\r"), Result::Done);
        QCOMPARE(ask(*roboteq, {Kind::ReadEncoders}, "?C\rC=-1:2147483647\r"), Result::Done);
        QCOMPARE(roboteq->counts(), (std::array{0xFFFFFFFFu, 0x7FFFFFFFu}));
    }

    void tellsWhichMotorCounts() {
        const auto pair = made("vesc"), alone = made("vesc alone"), opencr = made("opencr");
        QCOMPARE(ask(*pair, {Kind::ReadEncoders}, bothCounts), Result::Done); // the second one answers first
        QCOMPARE(pair->counts(), (std::array{7u, std::uint32_t(-1234)}));
        QCOMPARE(ask(*alone, {Kind::ReadEncoders}, vesc("32000220000000000701")), Result::Done);
        QCOMPARE(alone->counts(), (std::array{7u, 0u}));
        QCOMPARE(ask(*opencr, {Kind::ReadEncoders}, positions), Result::Done);
        QCOMPARE(opencr->counts(), (std::array{1u, std::uint32_t(-131073)}));
    }

    void tellsWhatItMeasures() {
        Readings readings;
        const auto vescs = made("vesc"), roboteq = made("roboteq");
        QCOMPARE(ask(*vescs, {Kind::ReadSlow}, bothMeasures), Result::Done);
        QCOMPARE(vescs->take({Kind::ReadSlow}, readings), std::string());
        QVERIFY(readings.complete && readings.temperature_c == 40 && readings.battery_v == 24.2);
        QCOMPARE(readings.current_a, (std::array{1.23, -2.0}));
        QCOMPARE(*readings.duty, (std::array{0.5, -0.5}));
        QVERIFY(!readings.faults[0] && readings.faults[1] == std::string("current too high"));
        QCOMPARE(ask(*roboteq, {Kind::ReadSlow, 0}, "V=135:246:4730\r"), Result::Done);
        QCOMPARE(roboteq->take({Kind::ReadSlow, 0}, readings), std::string());
        QCOMPARE(readings.battery_v, 24.6);
    }

    // Each set-point has another heartbeat, and nothing else has one.
    void theHeartbeatChanges() {
        const auto opencr = made("opencr");
        QByteArray last;
        for (int i = 0; i < 300; ++i) {
            const Bytes bytes = opencr->bytes({i % 7 == 0 ? Kind::CutPower : Kind::SetSpeeds});
            QVERIFY(hex(bytes) != last);
            last = hex(bytes);
            opencr->reader().begin(bytes);
            opencr->reader().begin(opencr->bytes({Kind::ReadEncoders}));
        }
    }

    void setsUpOnlyWhatStops_data() {
        const Rows<QString, int, QByteArray, bool, QString> row("kind", "step", "answer", "mayLack",
                                                                "refused");
        row("vesc", "vesc", 2, configuration("01000000C840A00000"), false, "");
        row("vesc, longer", "vesc", 2, configuration("01000003E840A00000"), false,
            "only after 1000 ms: set App Settings");
        row("vesc, longer where none is fine", "vesc", 2, configuration("01000003E840A00000"), true,
            "only after 1000 ms");
        row("vesc, never", "vesc", 2, configuration("010000000040A00000"), false, "never stops by itself");
        row("vesc, never, and that is fine", "vesc", 2, configuration("010000000000000000"), true, "");
        row("vesc, not a number", "vesc", 2, configuration("01000000C87FC00000"), false,
            "brake current that is none");
        row("vesc, negative", "vesc", 2, configuration("01000000C8BF800000"), false,
            "brake current that is none");
        row("vesc, one id twice", "vesc", 2, configuration("0A000000C840A00000"), false, "has the id 10");
        row("vesc, another id by CAN", "vesc", 3, configuration("0B000000C840A00000"), false,
            "has the id 11");
        row("vesc, longer by CAN", "vesc", 3, configuration("0A000000FA40A00000"), false,
            "on the CAN bus stops");
        row("opencr", "opencr", 1, opencr(QByteArray("000001") + QByteArray(60, '0')), false, "");
        row("opencr, debug mode", "opencr", 1, opencr(QByteArray("000101") + QByteArray(60, '0')), false,
            "debug mode");
        row("opencr, deaf", "opencr", 1, opencr(QByteArray("000000") + QByteArray(60, '0')), false,
            "heartbeat");
        row("opencr, no motors", "opencr", 2, opencr("000001"), false, "has not found its motors");
        row("opencr, no torque", "opencr", 2, opencr("000100"), false, "without torque");
        row("roboteq", "roboteq", 2, "RWD=200\r", false, "");
        row("roboteq, never", "roboteq", 2, "RWD=0\r", false, "has a time-out of 0 ms");
    }

    void setsUpOnlyWhatStops() {
        FETCH(QString, kind, int, step, QByteArray, answer, bool, mayLack, QString, refused);
        DeviceSettings settings = measures();
        settings.mayLackTimeout = mayLack;
        const auto device = made(kind, settings);
        Readings readings;
        QCOMPARE(ask(*device, {Kind::SetUp, step}, answer), Result::Done);
        const QString text = QString::fromStdString(device->take({Kind::SetUp, step}, readings));
        QVERIFY2(refused.isEmpty() ? text.isEmpty() : text.contains(refused), qPrintable(text));
    }

    void aVescTellsWhetherItRolls() {
        DeviceSettings settings = measures();
        settings.mayLackTimeout = true;
        const auto vescs = made("vesc", settings);
        Readings readings;
        const auto tell = [&](int step, const char *beginning) {
            QCOMPARE(ask(*vescs, {Kind::SetUp, step}, configuration(beginning)), Result::Done);
            QCOMPARE(vescs->take({Kind::SetUp, step}, readings), std::string());
        };
        tell(2, "01000000C840A00000");
        tell(3, "0A0000006440A00000");
        QVERIFY(vescs->timeout().seconds == 0.2 && !vescs->timeout().coasts); // the longer one
        tell(3, "0A000000C800000000");
        QVERIFY(vescs->timeout().coasts);
        tell(3, "0A0000000000000000");
        QVERIFY(std::isinf(vescs->timeout().seconds) && vescs->timeout().silence_s() == 0);
    }
};
