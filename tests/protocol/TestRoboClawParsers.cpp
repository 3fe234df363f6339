// What the parsers of both ends make of whole, damaged and foreign bytes.
#include "RoboClawBytes.h"
#include "protocol/roboclaw/Packet.h"
#include "protocol/roboclaw/Status.h"

using namespace hermes::roboclaw;

static std::vector<std::uint8_t> everyCommand() {
    std::vector<std::uint8_t> commands;
    for (int command = 0; command < 256; ++command) {
        if (layoutOf(std::uint8_t(command)))
            commands.push_back(std::uint8_t(command));
    }
    return commands;
}

static std::int64_t anyValue(char field, std::mt19937 &random) {
    const std::uint32_t raw = random() >> (random() % 3 * 8);
    return field == 'B'   ? raw & 0xFF
           : field == 'H' ? raw & 0xFFFF
           : field == 'h' ? std::int16_t(raw)
           : field == 'i' ? std::int32_t(raw)
                          : std::int64_t(raw);
}

static Values anyValues(std::string_view fields, std::mt19937 &random) {
    Values values;
    for (const char field : fields)
        values.push(anyValue(field, random));
    return values;
}

class TestRoboClawParsers : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void versionIsText() {
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
        QCOMPARE(parse(answer),
                 std::make_pair(ReplyParser::Result::Done, QByteArray("RoboClaw 10.2A v4.1.11")));
        QByteArray damaged = answer;
        damaged[3] = 'x';
        QCOMPARE(parse(damaged).first, ReplyParser::Result::BadCrc);
        QCOMPARE(parse(QByteArray(int(maxText) + 2, 'x')).first, ReplyParser::Result::Unexpected);
        QCOMPARE(parse(QByteArray("a\0\0\0", 4)).first, ReplyParser::Result::BadCrc);
        // Without the line feed that the manual has; its checksum fits.
        QByteArray bare("RoboClaw\0", 9);
        const auto *raw = reinterpret_cast<const std::uint8_t *>(bare.constData());
        const std::uint16_t crc =
            crc16(raw, std::size_t(bare.size()), crc16(request->bytes.data(), request->bytes.size()));
        bare.append(char(crc >> 8)).append(char(crc));
        QCOMPARE(parse(bare), std::make_pair(ReplyParser::Result::Done, QByteArray("RoboClaw")));
        QCOMPARE(parse(bytesOf(encodeText(*request, ""))).first, ReplyParser::Result::Done);
        const QByteArray longest = bytesOf(encodeText(*request, std::string(100, 'v')));
        QCOMPARE(parse(longest), std::make_pair(ReplyParser::Result::Done, QByteArray(46, 'v')));
    }

    void acknowledgementIsOneByte() {
        ReplyParser parser;
        QCOMPARE(parser.feed(0xFF), ReplyParser::Result::Unexpected); // nothing was asked
        parser.begin(*Request::make(0x80, Command::Speed, {0, 0}));
        QCOMPARE(parser.silence(), ReplyParser::Result::Incomplete);
        QCOMPARE(parser.feed(0xFF), ReplyParser::Result::Done);
        parser.begin(*Request::make(0x80, Command::Speed, {0, 0}));
        QCOMPARE(parser.feed(0xFE), ReplyParser::Result::Unexpected);
    }

    void statusOfBothWidths() {
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

    void everyCommandPassesBothWays() {
        std::mt19937 random(1);
        QCOMPARE(int(everyCommand().size()), 116);
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

    void everyFlippedBitIsSeen() {
        const auto write = Request::make(0x80, Command::SpeedAccel, {12000, 6000, -6000});
        for (std::size_t bit = 0; bit < write->bytes.size() * 8; ++bit) {
            RequestParser device;
            for (std::size_t i = 0; i < write->bytes.size(); ++i) {
                const std::uint8_t byte = std::uint8_t(write->bytes[i] ^ (bit / 8 == i ? 1 << bit % 8 : 0));
                if (device.feed(byte) == RequestParser::Result::Done)
                    QVERIFY2(device.request().isRead(), saying("bit %1 was not seen", bit));
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

    void deviceDropsPartsAndStrangers() {
        RequestParser device;
        QCOMPARE(device.feed(0x12), RequestParser::Result::Unknown);
        QCOMPARE(device.feed(0x80), RequestParser::Result::Incomplete);
        QCOMPARE(device.feed(73), RequestParser::Result::Unknown);
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

    void anyBytesAreBorne() {
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
                parser.begin(*Request::make(
                    0x80, command, anyValues(layout.isRead ? layout.arguments : layout.fields, random)));
            }
            if (parser.feed(std::uint8_t(random() % (i % 2 ? 256 : 11))) == ReplyParser::Result::Done)
                parser.begin(*Request::make(0x80, Command::ReadVersion));
        }
    }
};
