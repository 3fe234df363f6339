// From datagrams to turns: whose packets are decoded, and what the others are counted as.
#include "common/capture/LidarStream.h"
#include "tests/support/Sensor.h"

using namespace hermes;
using velodyne::TurnAssembler;

class TestLidarStream : public QObject {
    Q_OBJECT

    static Datagram from(Datagram datagram, std::uint32_t source) {
        datagram.source = source;
        return datagram;
    }

    static Datagram to(Datagram datagram, std::uint16_t port) {
        datagram.destinationPort = port;
        return datagram;
    }

    static inline const std::vector<std::uint8_t> noise =
        std::vector<std::uint8_t>(velodyne::packetSize, 'x');

private Q_SLOTS:
    void feedsAllAssemblersAlike() {
        Sensor sensor;
        LidarStream stream;
        TurnAssembler one({}, {}), other({}, {});
        for (int i = 0; i < 3; ++i) {
            const auto packet = sensor.packet(i);
            stream.take(sensorDatagram(packet, sensor.stamp(i)), {&one, nullptr, &other});
        }
        QCOMPARE(one.counts().packets, std::uint64_t(3));
        QCOMPARE(other.counts().packets, std::uint64_t(3));
        QCOMPARE(stream.sensors().taken()->packets, std::uint64_t(3));
    }

    void readsASensorOnAnyPort() {
        Sensor sensor;
        LidarStream stream;
        TurnAssembler turns({}, {});
        const auto packet = sensor.packet(0);
        stream.take(to(sensorDatagram(packet, sensor.stamp(0)), 4711), {&turns});
        QCOMPARE(turns.counts().packets, std::uint64_t(1));
        QCOMPARE(stream.other(), std::uint64_t(0));
    }

    void countsWhatIsDamaged() {
        Sensor sensor;
        LidarStream stream;
        TurnAssembler turns({}, {});
        stream.take(sensorDatagram(noise, 0), {&turns}); // to the port of data packets
        QCOMPARE(turns.counts().wrongFlag, std::uint64_t(1));
        const auto packet = sensor.packet(0);
        stream.take(to(sensorDatagram(packet, sensor.stamp(0)), 4711), {&turns});
        stream.take(to(sensorDatagram(noise, 0), 4711), {&turns}); // of the sensor that is taken
        QCOMPARE(turns.counts().wrongFlag, std::uint64_t(2));
        QCOMPARE(stream.other(), std::uint64_t(0));
    }

    void countsWhatIsOfNobody() {
        Sensor sensor;
        LidarStream stream;
        TurnAssembler turns({}, {});
        stream.take(to(sensorDatagram(noise, 0), 4711), {&turns});
        const auto packet = sensor.packet(0);
        stream.take(sensorDatagram(packet, sensor.stamp(0)), {&turns});
        stream.take(from(sensorDatagram(noise, 0), 0x0A000001), {&turns});
        QCOMPARE(turns.counts().packets, std::uint64_t(1));
        QCOMPARE(stream.other(), std::uint64_t(2));
    }

    // Whether it is the only sensor, another one beside that which is decoded, or comes in its place.
    void tellsOfAModelThatIsNotDecoded() {
        Sensor hdl, vlp;
        vlp.model = &velodyne::vlp16;
        LidarStream::Options options;
        options.model = velodyne::Model::Vlp16;
        LidarStream stream(options);
        TurnAssembler::Options decoded;
        decoded.model = options.model;
        TurnAssembler turns(decoded, {});
        const auto wrong = hdl.packet(0), right = vlp.packet(0);
        stream.take(sensorDatagram(wrong, hdl.stamp(0)), {&turns});
        QCOMPARE(turns.counts().otherModel, std::uint64_t(1));
        QVERIFY(!stream.sensors().taken());
        stream.take(sensorDatagram(right, vlp.stamp(0)), {&turns});
        QVERIFY(stream.sensors().taken());
        stream.take(from(sensorDatagram(wrong, hdl.stamp(1)), 0x0A000001), {&turns});
        QCOMPARE(turns.counts().otherModel, std::uint64_t(2));
        QCOMPARE(turns.counts().packets, std::uint64_t(3));
        QCOMPARE(stream.other(), std::uint64_t(0));
    }

    void leavesOutASecondSensor() {
        Sensor sensor;
        LidarStream stream;
        TurnAssembler turns({}, {});
        const auto packet = sensor.packet(0);
        stream.take(sensorDatagram(packet, sensor.stamp(0)), {&turns});
        stream.take(from(sensorDatagram(packet, sensor.stamp(0)), 0x0A000001), {&turns});
        QCOMPARE(turns.counts().packets, std::uint64_t(1));
        QCOMPARE(stream.otherSensors(), std::uint64_t(1));
        QCOMPARE(stream.sensors().sensors().size(), std::size_t(2));
    }

    /// Its hour begins anywhere: it is read by the receiver's clock until a GPS has set its own, and again
    /// when it was started anew.
    void whoseClockCounts() {
        constexpr std::int64_t second_ns = 1000000000, ahead_ns = 1234 * second_ns;
        Sensor sensor;
        LidarStream stream({{}, velodyne::Model::Blank, velodyne::dataPort, velodyne::ClockChoice::Auto});
        std::vector<std::pair<velodyne::StampSource, std::int64_t>>
            begun; // of turns: whose clock, how far off
        std::int64_t sent_ns = 0;
        TurnAssembler turns({}, [&](const velodyne::Turn &turn) {
            begun.emplace_back(turn.clock, std::abs(turn.begin_ns - sent_ns));
        });
        int number = 0;
        const auto turnOnce = [&](std::int64_t late_ns) {
            for (int i = 0; i < 200; ++i, ++number) { // over a turn
                const auto packet = sensor.packet(number);
                sent_ns = sensor.stamp(number) + late_ns;
                stream.take(sensorDatagram(packet, sent_ns + velodyne::hdl32e.packetPeriod_ns()), {&turns});
            }
        };
        const auto tellGps = [&](velodyne::Pps pps) {
            velodyne::PositionPacket position;
            position.stamp_us = std::uint32_t(sensor.stamp(number) / 1000 % velodyne::stampPeriod_us);
            position.pps = pps;
            position.nmea = "$GPRMC,221320,A,4124.8963,N,08151.6838,W,000.0,000.0,141123,000.0,W*";
            std::uint8_t sum = 0;
            for (const char c : position.nmea)
                sum ^= c == '$' || c == '*' ? 0 : std::uint8_t(c);
            position.nmea += QString("%1").arg(sum, 2, 16, QChar('0')).toUpper().toStdString();
            stream.take(sensorDatagram(encodePosition(position), sent_ns), {&turns});
        };
        turnOnce(ahead_ns);
        tellGps(velodyne::Pps::Absent);
        turnOnce(ahead_ns);
        QVERIFY(begun.size() > 1);
        for (const auto &[clock, off_ns] : begun) {
            QVERIFY(clock == velodyne::StampSource::Host);
            QVERIFY(off_ns < second_ns / 5);
        }
        begun.clear();
        tellGps(velodyne::Pps::Locked);
        turnOnce(ahead_ns);
        tellGps(velodyne::Pps::Absent); // its clock goes on
        turnOnce(ahead_ns);
        QVERIFY(begun.size() > 2);
        begun.erase(begun.begin()); // what was under way
        for (const auto &[clock, off_ns] : begun)
            QVERIFY(off_ns > ahead_ns - second_ns);
        QVERIFY(begun[0].first == velodyne::StampSource::Gps);
        turnOnce(ahead_ns + 600 * second_ns); // the host's clock was set: the GPS knows better
        QVERIFY(begun.back().first == velodyne::StampSource::Gps);
        sensor.start_ns += 5000 * second_ns;
        turnOnce(ahead_ns - 4000 * second_ns);
        QVERIFY(begun.back().first == velodyne::StampSource::Host);
        QVERIFY(begun.back().second < second_ns / 5);
    }
};
