// Requests and answers as bytes.
#include "RoboClawBytes.h"
#include "protocol/roboclaw/Packet.h"
#include "protocol/roboclaw/Status.h"

using namespace hermes::roboclaw;

Q_DECLARE_METATYPE(hermes::roboclaw::Values)
Q_DECLARE_METATYPE(hermes::roboclaw::Command)

/// The byte strings were computed apart from this code (packet serial, polynomial 0x1021).
class TestRoboClaw : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void crcHasItsCheckValue() {
        QCOMPARE(int(crc16(reinterpret_cast<const std::uint8_t *>("123456789"), 9)), 0x31C3);
    }

    void writesAreEncoded_data() {
        const Rows<int, Command, Values, QByteArray> row("address", "command", "values", "bytes");
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

    void writesAreEncoded() {
        FETCH(int, address, Command, command, Values, values, QByteArray, bytes);
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

    void readsAreEncodedAndAnswered_data() {
        const Rows<Command, Values, QByteArray, QByteArray> row("command", "values", "sent", "answer");
        row("battery", Command::ReadMainBattery, {240}, "80 18", "00 F0 D8 E5");
        row("encoder", Command::ReadEncoderM1, {1000, 0}, "80 10", "00 00 03 E8 00 71 36");
        row("speed", Command::ReadSpeedM1, {-1000, 1}, "80 12", "FF FF FC 18 01 27 F9");
        row("counts", Command::ReadEncoders, {1000, 0xFFFFFC18}, "80 4E", "00 00 03 E8 FF FF FC 18 7E 0E");
        row("currents", Command::ReadCurrents, {150, -20}, "80 31", "00 96 FF EC 87 5B");
        row("buffers", Command::ReadBuffers, {0x80, 0x80}, "80 2F", "80 80 FD DF");
        row("temperature", Command::ReadTemperature, {305}, "80 52", "01 31 F8 D5");
        row("status", Command::ReadStatus, {EmergencyStop | MainVoltageLowWarning}, "80 5A",
            "00 08 00 01 3E 3C");
        row("PID", Command::ReadVelocityPidM1, {0x10000, 0x8000, 0x4000, 44000}, "80 37",
            "00 01 00 00 00 00 80 00 00 00 40 00 00 00 AB E0 AB C0");
    }

    void readsAreEncodedAndAnswered() {
        FETCH(Command, command, Values, values, QByteArray, sent, QByteArray, answer);
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

    void layoutsHaveTheirSizes_data() {
        const Rows<QVector<int>, bool, int> row("commands", "isRead", "size");
        row("W 1", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 26, 27, 92, 93, 148}, false, 1);
        row("W 0", {20, 80, 95}, false, 0);
        row("W 2", {32, 33, 70, 71, 98}, false, 2);
        row("W 3", {74, 253}, false, 3);
        row("W 4", {22, 23, 34, 35, 36, 57, 58, 68, 69, 94}, false, 4);
        row("W 6", {52, 53}, false, 6);
        row("W 8", {37, 38, 39, 109, 112, 133, 134}, false, 8);
        row("W 9", {41, 42}, false, 9);
        row("W 12", {40, 54}, false, 12);
        row("W 13", {44, 45}, false, 13);
        row("W 16", {28, 29, 50}, false, 16);
        row("W 17", {43, 65, 66}, false, 17);
        row("W 21", {46}, false, 21);
        row("W 25", {51}, false, 25);
        row("W 28", {61, 62}, false, 28);
        row("W 33", {67}, false, 33);
        row("R 1", {15, 149}, true, 1);
        row("R 2", {24, 25, 47, 82, 83, 91, 99, 252}, true, 2);
        row("R 3", {75}, true, 3);
        row("R 4", {48, 49, 59, 60, 90}, true, 4);
        row("R 5", {16, 17, 18, 19, 30, 31}, true, 5);
        row("R 8", {78, 79, 81, 108, 110, 113, 135, 136}, true, 8);
        row("R 16", {55, 56}, true, 16);
        row("R 28", {63, 64}, true, 28);
    }

    void layoutsHaveTheirSizes() {
        QFETCH(QVector<int>, commands);
        for (const int command : commands) {
            const Layout *layout = layoutOf(std::uint8_t(command));
            QVERIFY2(layout, saying("command %1", command));
            QCOMPARE(int(layout->command), command);
            QTEST(layout->isRead, "isRead");
            QTEST(int(sizeOf(layout->fields)), "size");
        }
    }

    void refusesWhatDoesNotFit_data() {
        const Rows<int, int, Values> row("address", "command", "values");
        row("address below", 0x7F, 37, {0, 0});
        row("address above", 0x88, 37, {0, 0});
        row("no command", 0x80, 73, {});
        row("too few", 0x80, 37, {0});
        row("too many", 0x80, 37, {0, 0, 0});
        row("far too many", 0x80, 37, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
        row("speed too large", 0x80, 35, {std::int64_t(INT32_MAX) + 1});
        row("speed too small", 0x80, 35, {std::int64_t(INT32_MIN) - 1});
        row("negative acceleration", 0x80, 38, {-1, 0});
        row("duty too large", 0x80, 32, {32768});
        row("byte too large", 0x80, 14, {256});
        row("read with a value", 0x80, 90, {1});
        row("EEPROM without address", 0x80, 252, {});
    }

    void refusesWhatDoesNotFit() {
        FETCH(int, address, int, command, Values, values);
        QVERIFY(!Request::make(std::uint8_t(address), Command(command), values));
    }

    void speedsHaveTheirSign_data() {
        const Rows<Values, int> row("values", "speed");
        row("forward", {1000, 0}, 1000);
        row("two's complement", {-1000, 1}, -1000);
        row("magnitude and direction", {1000, 1}, -1000);
        row("negative without direction", {-1000, 0}, -1000);
        row("smallest", {INT32_MIN, 1}, INT32_MIN);
    }

    void speedsHaveTheirSign() {
        QFETCH(Values, values);
        QTEST(signedSpeed(Reply{values, {}}), "speed");
    }
};
