// What one packet says: its returns, angles and points.
#include "protocol/velodyne/TurnAssembler.h"
#include "tests/support/Sensor.h"

#include <stdexcept>

using namespace hermes::velodyne;

Q_DECLARE_METATYPE(std::function<void(SensorModel &)>)

class TestPacketDecoder : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void elevationsAreMultiplesOfFourThirds() {
        for (int laser = 0; laser < hdl32e.lasers; ++laser) {
            const int ring = laser % 2 == 0 ? laser / 2 : 16 + (laser - 1) / 2;
            QVERIFY(std::abs(hdl32e.laser[laser].elevation_deg - (ring - 23) * 4 / 3.0) < 0.0051);
        }
        QCOMPARE(hdl32e.laser[hdl32e.horizonLaser].elevation_deg, 0.0);
    }

    void packetsComeBackToTheLastBit() {
        std::mt19937 random(newSeed());
        for (int round = 0; round < 50; ++round) {
            DataPacketWriter writer;
            std::vector<unsigned> written;
            for (int block = 0; block < blocksPerPacket; ++block) {
                written.push_back(random() % azimuthSteps);
                writer.setAzimuth(block, std::uint16_t(written.back()));
                for (int laser = 0; laser < hdl32e.lasers; ++laser) {
                    written.push_back(random() & 0xFFFF);
                    written.push_back(random() & 0xFF);
                    writer.setReturn(block, laser, std::uint16_t(written[written.size() - 2]),
                                     std::uint8_t(written.back()));
                }
            }
            written.push_back(unsigned(random() % stampPeriod_us));
            writer.setTail(written.back());
            QCOMPARE(DataPacket::check(writer.bytes().data(), packetSize), PacketFault::None);

            const DataPacket packet(writer.bytes().data());
            std::vector<unsigned> read;
            for (int block = 0; block < blocksPerPacket; ++block) {
                read.push_back(packet.azimuth(block));
                for (int laser = 0; laser < hdl32e.lasers; ++laser) {
                    read.push_back(packet.distance(block, laser));
                    read.push_back(packet.intensity(block, laser));
                }
            }
            read.push_back(packet.stamp_us());
            QVERIFY(read == written);
            QVERIFY(packet.returnMode() == ReturnMode::Strongest && packet.model() == Model::Hdl32e);
        }
    }

    void faultsAreNamed_data() {
        const Rows<int, int, int, int> row("size", "offset", "value", "fault");
        row("whole", 1206, -1, 0, int(PacketFault::None));
        row("short", 1205, -1, 0, int(PacketFault::Size));
        row("position packet", 512, -1, 0, int(PacketFault::Size));
        row("empty", 0, -1, 0, int(PacketFault::Size));
        row("first flag", 1206, 0, 0xFE, int(PacketFault::Flag));
        row("last flag", 1206, 1101, 0, int(PacketFault::Flag));
        row("azimuth", 1206, 3, 0x8D, int(PacketFault::Value));
        row("stamp beyond the hour", 1206, 1203, 0xFF, int(PacketFault::None));
        row("VLP-16", 1206, 1205, 0x22, int(PacketFault::None));
        row("VLP-32C", 1206, 1205, 0x28, int(PacketFault::Model));
        row("model without mode", 1206, 1204, 0, int(PacketFault::Model));
        row("unknown mode", 1206, 1204, 0x40, int(PacketFault::Model));
        row("dual", 1206, 1204, 0x39, int(PacketFault::None));
    }

    void faultsAreNamed() {
        FETCH(int, size, int, offset, int, value, int, fault);
        auto bytes = Sensor().packet(0);
        if (offset >= 0)
            bytes[std::size_t(offset)] = std::uint8_t(value);
        QCOMPARE(int(DataPacket::check(bytes.data(), std::size_t(size))), fault);
    }

    void pointsLieWhereTheFactSheetSays() {
        // Values of an independent decoder, which has all lasers in the sensor's origin: 2500 counts straight
        // ahead.
        Sensor sensor;
        auto bytes = sensor.packet(0);
        bytes[2] = bytes[3] = bytes[102] = bytes[103] = 0; // no gap: every laser at azimuth 0
        std::vector<Point> points;
        PacketDecoder(hdl32e, PacketDecoder::allLasers, Returns::Strongest, false)
            .decode(DataPacket(bytes.data()), 0, 0, 0, points);
        QCOMPARE(points.size(), std::size_t(hdl32e.lasers));
        QVERIFY(std::abs(points[0].x - 4.3008) < 5e-4 && points[0].y == 0 &&
                std::abs(points[0].z + 2.5505) < 5e-4);
        QCOMPARE(points[15].x, 5.0);
        QCOMPARE(points[15].z, 0.0);
        QCOMPARE(points[31].stamp_ns, std::int64_t(31 * 1152));
        // A quarter turn clockwise is to the right: y is negative.
        bytes[2] = bytes[102] = 9000 & 0xFF;
        bytes[3] = bytes[103] = 9000 >> 8;
        points.clear();
        PacketDecoder(hdl32e).decode(DataPacket(bytes.data()), 0, 0, 0, points);
        QVERIFY(std::abs(points[0].x) < 1e-9 && std::abs(points[0].y + 5) < 1e-9);
    }

    void lasersLieAtTheirDocumentedHeights_data() {
        const Rows<int, int, double> row("model", "laser", "height_mm");
        row("VLP-16, the lowest", int(Model::Vlp16), 0, 11.2);
        row("VLP-16, +1 degree", int(Model::Vlp16), 1, -0.7);
        row("VLP-16, -1 degree", int(Model::Vlp16), 14, 0.7);
        row("VLP-16, the highest", int(Model::Vlp16), 15, -11.2);
        row("HDL-32E, the lowest", int(Model::Hdl32e), 0, 17.17);
        row("HDL-32E, the horizon", int(Model::Hdl32e), 15, 0.0);
        row("HDL-32E, the highest", int(Model::Hdl32e), 31, -5.45);
    }

    /// The manual of the VLP-16: "After computing X,Y,Z, apply the vertical correction".
    void lasersLieAtTheirDocumentedHeights() {
        FETCH(int, model, int, laser, double, height_mm);
        Sensor sensor;
        sensor.model = findSensorModel(Model(model));
        const auto bytes = sensor.packet(0);
        std::vector<Point> with, without;
        for (const bool offsets : {true, false})
            PacketDecoder(*sensor.model, laser, Returns::Strongest, offsets)
                .decode(DataPacket(bytes.data()), 0, 0, 0, offsets ? with : without);
        QCOMPARE(with.size(), std::size_t(1));
        QVERIFY(std::abs((with[0].z - without[0].z) * 1000 - height_mm) < 1e-9);
        QVERIFY(with[0].x == without[0].x && with[0].y == without[0].y && with[0].range == without[0].range);
    }

    void azimuthsAreInterpolated() {
        DataPacketWriter writer;
        for (int block = 0; block < blocksPerPacket; ++block) {
            writer.setAzimuth(block, std::uint16_t((35990 + 16 * block) % azimuthSteps));
            writer.setReturn(block, 15, 1000, 7);
        }
        std::vector<Point> points;
        const DataPacket packet(writer.bytes().data());
        for (int group = 0; group < blocksPerPacket; ++group)
            PacketDecoder(hdl32e).decode(packet, group, 0, 1000, points);
        QCOMPARE(points.size(), std::size_t(12));
        QVERIFY(std::abs(points[0].azimuth - (359.90 + 0.16 * 0.375)) < 1e-9);
        QVERIFY(std::abs(points[1].azimuth - (0.06 + 0.16 * 0.375)) < 1e-9);
        QVERIFY(std::abs(points[11].azimuth - (1.66 + 0.16 * 0.375)) < 1e-9); // by the gap before it
        QCOMPARE(points[11].stamp_ns, std::int64_t(1000 + 11 * 46080 + 15 * 1152));
        writer.setAzimuth(1, 5000); // a jump is no gap
        QCOMPARE(azimuthGap(packet, 0), 0);
    }

    void aBlockOfAVlp16HoldsTwoFirings() {
        DataPacketWriter writer;
        for (int block = 0; block < blocksPerPacket; ++block)
            writer.setAzimuth(block, std::uint16_t((35970 + 40 * block) % azimuthSteps));
        writer.setReturn(0, 3, 1000, 1);   // laser 3 of the first firing
        writer.setReturn(0, 19, 2000, 2);  // and of the second
        writer.setReturn(11, 31, 3000, 3); // the last of all
        writer.setTail(0, ReturnMode::Last, Model::Vlp16);
        std::vector<Point> points;
        const DataPacket packet(writer.bytes().data());
        const PacketDecoder decoder(vlp16, PacketDecoder::allLasers, Returns::Strongest, false);
        for (int group = 0; group < blocksPerPacket; ++group)
            for (int firing = 0; firing < 2; ++firing)
                decoder.decode(packet, group, firing, 500, points);
        QCOMPARE(points.size(), std::size_t(3));
        QCOMPARE(int(points[0].laser), 3);
        QCOMPARE(points[0].stamp_ns, std::int64_t(500 + 3 * 2304));
        QCOMPARE(points[0].azimuth, 359.725); // 359.70 + 0.40 * 3 / 48
        QCOMPARE(points[0].z, 2 * std::sin(3 * 3.14159265358979323846 / 180));
        QCOMPARE(int(points[1].laser), 3);
        QCOMPARE(points[1].stamp_ns, std::int64_t(500 + 55296 + 3 * 2304));
        QCOMPARE(points[1].azimuth, 359.925);
        QCOMPARE(int(points[2].laser), 15);
        QCOMPARE(points[2].stamp_ns, std::int64_t(500 + 11 * 110592 + 55296 + 15 * 2304));
        QCOMPARE(points[2].azimuth, 4.425); // 4.10 + 0.40 * (1 / 2 + 15 / 48)
    }

    void ringsCountFromTheLowest() {
        QCOMPARE(hdl32e.ring(0), 0);
        QCOMPARE(hdl32e.ring(15), 23);
        QCOMPARE(hdl32e.ring(31), 31);
        QCOMPARE(vlp16.ring(0), 0);
        QCOMPARE(vlp16.ring(1), 8);
        QCOMPARE(vlp16.ring(15), 15);
    }

    void modelsThatCannotBeReadAreRefused_data() {
        Rows<std::function<void(SensorModel &)>, QString>("spoil", "fault");
        const auto row = [](const char *name, std::function<void(SensorModel &)> spoil, const char *fault) {
            QTest::newRow(name) << std::move(spoil) << fault;
        };
        row(
            "the byte of another", [](SensorModel &m) { m.model = Model::Vlp16; }, "another's");
        row(
            "no byte", [](SensorModel &m) { m.model = Model::Blank; }, "another's");
        row(
            "the key of another", [](SensorModel &m) { m.key = "hdl32e"; }, "another's");
        row(
            "more lasers than a block has", [](SensorModel &m) { m.lasers = 33; }, "32 returns");
        row(
            "more firings than a block has", [](SensorModel &m) { m.firingsPerBlock = 2; }, "32 returns");
        row(
            "no laser", [](SensorModel &m) { m.lasers = 0; }, "32 returns");
        row(
            "a horizon that is nowhere", [](SensorModel &m) { m.horizonLaser = 32; }, "horizon");
        row(
            "no time between firings", [](SensorModel &m) { m.firingPeriod_ns = 0; }, "period");
        row(
            "no laser at once", [](SensorModel &m) { m.lasersAtOnce = 0; }, "period");
        row(
            "no unit", [](SensorModel &m) { m.distanceCounts = 0; }, "unit");
        static Laser bent[32] = {{0, 0, std::nan("")}};
        row(
            "no angle", [](SensorModel &m) { m.laser = bent; }, "angle");
    }

    void modelsThatCannotBeReadAreRefused() {
        FETCH(const std::function<void(SensorModel &)>, spoil, const QString, fault);
        SensorModel model = hdl32e;
        model.model = Model(0x28);
        model.key = "new";
        spoil(model);
        try {
            addSensorModel(model);
            QFAIL("it was added");
        } catch (const std::invalid_argument &e) {
            QVERIFY2(QString(e.what()).contains(fault), e.what());
        }
        QCOMPARE(sensorModels().size(), std::size_t(2));
        QVERIFY(modelChoices() == (std::vector<std::string>{"auto", "hdl32e", "vlp16"}));
        QCOMPARE(horizonLasers(), std::string("HDL-32E: 15, VLP-16: 1"));
    }

    void dualReturns_data() {
        const Rows<int, bool, QVector<double>> row("returns", "same", "ranges");
        row("strongest", int(Returns::Strongest), false, {5.0});
        row("last", int(Returns::Last), false, {5.2});
        row("both", int(Returns::Both), false, {5.2, 5.0});
        row("both the same", int(Returns::Both), true, {5.0});
    }

    void dualReturns() {
        FETCH(int, returns, bool, same, QVector<double>, ranges);
        Sensor sensor;
        sensor.dual = true;
        auto bytes = sensor.packet(0);
        const DataPacket packet(bytes.data());
        QCOMPARE(packet.groups(), 6);
        if (same)
            std::copy(bytes.begin() + 104, bytes.begin() + 200, bytes.begin() + 4);
        std::vector<Point> points;
        PacketDecoder(hdl32e, hdl32e.horizonLaser, Returns(returns)).decode(packet, 0, 0, 0, points);
        QCOMPARE(int(points.size()), ranges.size());
        for (int i = 0; i < ranges.size(); ++i)
            QVERIFY(std::abs(points[std::size_t(i)].range - ranges[i]) < 1e-9);
        points.clear();
        PacketDecoder(hdl32e).decode(packet, 5, 0, 0, points);
        QCOMPARE(points[0].stamp_ns, std::int64_t(5 * 46080 + 15 * 1152));
    }
};
