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
};
