#include "common/capture/PcapReader.h"
#include "protocol/velodyne/PositionPacket.h"

#include <cstring>

using namespace hermes;
using namespace hermes::velodyne;

class TestPosition : public QObject {
    Q_OBJECT

    using Bytes = std::array<std::uint8_t, positionPacketSize>;
    static constexpr std::int64_t second_ns = 1000000000;
    static inline const char *const valid =
        "$GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D*05";
    static constexpr std::int64_t rmcTime_s = 1437687666; // 2015-07-23 21:41:06 UTC

    static QByteArray summed(const QByteArray &body) {
        const auto sum = nmea::checksum({body.constData(), std::size_t(body.size())});
        return '$' + body + '*' + QByteArray::number(sum, 16).rightJustified(2, '0');
    }

    static Bytes packet(std::uint32_t stamp_us, std::uint8_t pps, const char *text) {
        Bytes bytes{};
        for (int i = 0; i < 4; ++i)
            bytes[std::size_t(0xC6 + i)] = std::uint8_t(stamp_us >> 8 * i);
        bytes[0xCA] = pps;
        std::copy(text, text + std::strlen(text), bytes.begin() + 0xCE);
        return bytes;
    }

    static GpsReader read(const Bytes &bytes) {
        GpsReader gps;
        if (gps.feed(bytes.data(), bytes.size()) != PositionFault::None)
            qFatal("a sound packet was refused");
        return gps;
    }

private Q_SLOTS:
    /// The worked examples of the manual.
    void wordsAreOf12Bits() {
        Bytes bytes{};
        const std::uint8_t words[] = {0xDE, 0x0F, 0x55, 0x10, 0x1B, 0x23, 0xFF, 0xFF};
        std::copy(std::begin(words), std::end(words), bytes.begin() + 0x0E + 16); // of the third chip
        PositionPacket position;
        QCOMPARE(decodePosition(bytes.data(), bytes.size(), position), PositionFault::None);
        QVERIFY(std::abs(position.chips[2].gyro_dps + 3.32) < 0.005);
        QVERIFY(std::abs(position.chips[2].temperature_c - 37.35) < 0.005);
        QVERIFY(std::abs(position.chips[2].accelX_g - 0.971) < 0.0005);
        QVERIFY(std::abs(position.chips[2].accelY_g + 0.001221) < 1e-9);
        QCOMPARE(position.chips[0].gyro_dps, 0.0);
        QCOMPARE(position.chips[0].temperature_c, 25.0);
        QVERIFY(position.nmea.empty() && position.pps == Pps::Absent);
    }

    void faultsAreNamed_data() {
        const Rows<int, int, int, int> row("size", "offset", "value", "fault");
        row("whole", 512, 0, 0, int(PositionFault::None));
        row("short", 511, 0, 0, int(PositionFault::Size));
        row("data packet", 1206, 0, 0, int(PositionFault::Size));
        row("empty", 0, 0, 0, int(PositionFault::Size));
        row("stamp beyond the hour", 512, 0xC9, 0xFF, int(PositionFault::None));
        row("pulse", 512, 0xCA, 4, int(PositionFault::Value));
    }

    void faultsAreNamed() {
        FETCH(int, size, int, offset, int, value, int, fault);
        std::vector<std::uint8_t> bytes(2000);
        bytes[std::size_t(offset)] = std::uint8_t(value);
        GpsReader gps;
        QCOMPARE(int(gps.feed(bytes.data(), std::size_t(size))), fault);
        QCOMPARE(gps.counts().packets, std::uint64_t(1));
        QCOMPARE(gps.counts().wrongSize, std::uint64_t(fault == int(PositionFault::Size)));
        QCOMPARE(gps.counts().wrongValue, std::uint64_t(fault == int(PositionFault::Value)));
    }

    void theHourIsTrusted_data() {
        const Rows<int, QByteArray, bool, bool> row("pps", "text", "valid", "trusted");
        row("locked, valid", 2, QByteArray(valid), true, true);
        row("no pulse", 0, QByteArray(valid), true, false);
        row("synchronizing", 1, QByteArray(valid), true, false);
        row("error", 3, QByteArray(valid), true, false);
        row("warning", 2, "$GPRMC,214106,V,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D*12", false,
            false);
        row("no variation", 2, summed("GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,999.9,,D"),
            true, true);
        row("no date", 2, "$GPRMC,214106,A,,,,,,,,,*26", true, false);
        row("another sentence", 2, "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47", false,
            false);
        row("no GPS", 2, QByteArray(), false, false);
    }

    void theHourIsTrusted() {
        FETCH(int, pps, QByteArray, text, bool, trusted);
        const GpsReader gps = read(packet(2467110195, std::uint8_t(pps), text.constData()));
        QTEST(gps.state().valid, "valid");
        QCOMPARE(gps.state().utc_ns.has_value(), trusted);
        QCOMPARE(gps.counts().badNmea, std::uint64_t(0));
    }

    void theHourAtItsEdges_data() {
        const Rows<QByteArray, qint64, qint64> row("time", "stamp_us", "ofDay_s");
        row("within the hour", "214106", 2467110195LL, (21 * 3600 + 2467LL));
        row("the counter is in the next hour", "215959", 200000LL, 22 * 3600LL);
        row("the sentence is in the next hour", "220000", 3599900000LL, 22 * 3600LL - 1);
        row("and in the next day", "235959", 100000LL, 24 * 3600LL);
    }

    void theHourAtItsEdges() {
        FETCH(QByteArray, time, qint64, stamp_us, qint64, ofDay_s);
        const QByteArray text =
            summed("GPRMC," + time + ",A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D");
        const GpsReader gps = read(packet(std::uint32_t(stamp_us), 2, text.constData()));
        QVERIFY(gps.state().utc_ns.has_value());
        const std::int64_t day_s = rmcTime_s / 86400 * 86400;
        QCOMPARE(*gps.state().utc_ns / second_ns, day_s + ofDay_s);
        QCOMPARE(*gps.state().utc_ns % (3600 * second_ns), stamp_us * 1000);
    }

    void badTextIsCounted_data() {
        const Rows<QByteArray> row("text");
        row("checksum", "$GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D*06");
        row("cut", "$GPRMC,214106,A,3707.8178,N,12139.2690");
        row("not ASCII", "$GPRMC,2141\xC3\xA4,A*00");
        row("no sentence", "hello");
        row("two sentences in one", "$GPRMC,2141$GPRMC,214106,A*00");
        row("no end", QByteArray(int(positionPacketSize) - 0xCE, 'A'));
    }

    void badTextIsCounted() {
        QFETCH(QByteArray, text);
        const GpsReader gps = read(packet(2467110195, 2, text.constData()));
        QCOMPARE(gps.counts().badNmea, std::uint64_t(1));
        QVERIFY(!gps.state().valid && !gps.state().utc_ns && !gps.state().position);
        QVERIFY(gps.state().packet.nmea.size() <= maximumNmea);
    }

    void aFaultChangesNothing() {
        GpsReader gps = read(packet(2467110195, 2, valid));
        Bytes wrong = packet(5, 9, "");
        QCOMPARE(gps.feed(wrong.data(), wrong.size()), PositionFault::Value);
        QVERIFY(gps.state().valid && gps.state().packet.stamp_us == 2467110195);
        const Bytes lost = packet(2467110295, 0, valid); // the pulse has gone
        gps.feed(lost.data(), lost.size());
        QVERIFY(!gps.state().utc_ns);
    }

    void aRealPacket() {
        REAL_DATA(path, "velodyne-position-packet.pcap");
        PcapReader reader;
        Datagram datagram;
        QVERIFY(reader.open(path.toStdString()));
        QCOMPARE(reader.next(datagram), PcapReader::Next::Datagram);
        QCOMPARE(datagram.destinationPort, positionPort);
        GpsReader gps;
        QCOMPARE(gps.feed(datagram.payload, datagram.size), PositionFault::None);
        QCOMPARE(gps.state().packet.nmea, std::string(valid));
        QCOMPARE(gps.state().packet.stamp_us, 2467110195u);
        QVERIFY(gps.state().packet.pps == Pps::Locked && gps.state().valid);
        // The sentence is of 21:41:06, the packet of 21:41:07.110195.
        QCOMPARE(*gps.state().utc_ns, rmcTime_s * second_ns + 1110195000);
        QVERIFY(std::abs(gps.state().position->longitude_deg + 121.65448) < 1e-5);
    }

    void randomBytesDoNoHarm() {
        std::mt19937 random(newSeed());
        GpsReader gps;
        Bytes bytes;
        for (int round = 0; round < 20000; ++round) {
            if (round % 3 == 0)
                for (std::uint8_t &byte : bytes)
                    byte = std::uint8_t(random());
            else
                bytes = packet(random() % stampPeriod_us, std::uint8_t(random() % 5), valid);
            bytes[0xCE + random() % maximumNmea] = std::uint8_t(random());
            gps.feed(bytes.data(), bytes.size());
        }
        QCOMPARE(gps.counts().packets, std::uint64_t(20000));
        QVERIFY(gps.counts().wrongValue > 2000 && gps.counts().badNmea > 2000);
    }
};
