#include "protocol/velodyne/TurnAssembler.h"
#include "tests/support/Sensor.h"

#include <QtTest>

#include <cmath>
#include <random>

using namespace hermes::velodyne;

namespace {

constexpr std::int64_t second_ns = 1000000000;
constexpr std::int64_t hour_ns = 3600 * second_ns;

PacketFault feed(TurnAssembler &assembler, const Sensor &sensor, int number) {
    const auto bytes = sensor.packet(number);
    return assembler.feed(bytes.data(), bytes.size(), sensor.stamp(number) + 200000);
}

} // namespace

class TestVelodyne : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void elevationsAreMultiplesOfFourThirds();
    void packetsComeBackToTheLastBit();
    void faultsAreNamed_data();
    void faultsAreNamed();
    void pointsLieWhereTheFactSheetSays();
    void azimuthsAreInterpolated();
    void aBlockOfAVlp16HoldsTwoFirings();
    void ringsCountFromTheLowest();
    void dualReturns_data();
    void dualReturns();
    void stampsTakeTheHourOfTheReceiveTime_data();
    void stampsTakeTheHourOfTheReceiveTime();
    void stampsOfAFreeRunningSensorDoNotJump();
    void aGpsTellsTheHour();
    void turnsBeginWhereTheAzimuthWraps();
    void turnsOfAVlp16();
    void theFirstOfTwoSensorsIsDecoded();
    void aSettingNamesTheSensor();
    void everyNthFiringOnly();
    void aJumpIsNoLoss();
    void lossesAreCounted();
    void latePacketsAreCountedAndLeftOut();
    void aLongGapCutsTheTurn();
    void aClockJumpIsNoLoss();
    void aHeadThatStandsStillDoesNotFillTheMemory();
    void turnsThatEndBeforeTheyBeginHaveNoSpeed();
    void randomBytesDoNoHarm();
};

void TestVelodyne::elevationsAreMultiplesOfFourThirds() {
    for (int laser = 0; laser < lasers; ++laser) {
        const int ring = laser % 2 == 0 ? laser / 2 : 16 + (laser - 1) / 2;
        QVERIFY(std::abs(elevation_deg[laser] - (ring - 23) * 4 / 3.0) < 0.0051);
    }
    QCOMPARE(elevation_deg[horizonLaser], 0.0);
}

void TestVelodyne::packetsComeBackToTheLastBit() {
    const unsigned seed = std::random_device()();
    qInfo("seed %u", seed);
    std::mt19937 random(seed);
    for (int round = 0; round < 50; ++round) {
        DataPacketWriter writer;
        std::vector<unsigned> written;
        for (int block = 0; block < blocksPerPacket; ++block) {
            written.push_back(random() % azimuthSteps);
            writer.setAzimuth(block, std::uint16_t(written.back()));
            for (int laser = 0; laser < lasers; ++laser) {
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
            for (int laser = 0; laser < lasers; ++laser) {
                read.push_back(packet.distance(block, laser));
                read.push_back(packet.intensity(block, laser));
            }
        }
        read.push_back(packet.stamp_us());
        QVERIFY(read == written);
        QVERIFY(packet.returnMode() == ReturnMode::Strongest && packet.model() == Model::Hdl32e);
    }
}

void TestVelodyne::faultsAreNamed_data() {
    QTest::addColumn<int>("size");
    QTest::addColumn<int>("offset");
    QTest::addColumn<int>("value");
    QTest::addColumn<int>("fault");
    QTest::newRow("whole") << 1206 << -1 << 0 << int(PacketFault::None);
    QTest::newRow("short") << 1205 << -1 << 0 << int(PacketFault::Size);
    QTest::newRow("position packet") << 512 << -1 << 0 << int(PacketFault::Size);
    QTest::newRow("empty") << 0 << -1 << 0 << int(PacketFault::Size);
    QTest::newRow("first flag") << 1206 << 0 << 0xFE << int(PacketFault::Flag);
    QTest::newRow("last flag") << 1206 << 1101 << 0 << int(PacketFault::Flag);
    QTest::newRow("azimuth") << 1206 << 3 << 0x8D << int(PacketFault::Value);
    QTest::newRow("stamp") << 1206 << 1203 << 0xFF << int(PacketFault::Value);
    QTest::newRow("VLP-16") << 1206 << 1205 << 0x22 << int(PacketFault::None);
    QTest::newRow("VLP-32C") << 1206 << 1205 << 0x28 << int(PacketFault::Model);
    QTest::newRow("model without mode") << 1206 << 1204 << 0 << int(PacketFault::Model);
    QTest::newRow("unknown mode") << 1206 << 1204 << 0x40 << int(PacketFault::Model);
    QTest::newRow("dual") << 1206 << 1204 << 0x39 << int(PacketFault::None);
}

void TestVelodyne::faultsAreNamed() {
    QFETCH(int, size);
    QFETCH(int, offset);
    QFETCH(int, value);
    QFETCH(int, fault);
    auto bytes = Sensor().packet(0);
    if (offset >= 0)
        bytes[std::size_t(offset)] = std::uint8_t(value);
    QCOMPARE(int(DataPacket::check(bytes.data(), std::size_t(size))), fault);
}

void TestVelodyne::pointsLieWhereTheFactSheetSays() {
    // Values of an independent decoder: 2500 counts straight ahead.
    Sensor sensor;
    auto bytes = sensor.packet(0);
    bytes[2] = bytes[3] = bytes[102] = bytes[103] = 0; // no gap: every laser at azimuth 0
    std::vector<Point> points;
    PacketDecoder(hdl32e(), PacketDecoder::allLasers).decode(DataPacket(bytes.data()), 0, 0, 0, points);
    QCOMPARE(points.size(), std::size_t(lasers));
    QVERIFY(std::abs(points[0].x - 4.3008) < 5e-4 && points[0].y == 0 &&
            std::abs(points[0].z + 2.5505) < 5e-4);
    QCOMPARE(points[15].x, 5.0);
    QCOMPARE(points[15].z, 0.0);
    QCOMPARE(points[31].stamp_ns, std::int64_t(31 * 1152));
    // A quarter turn clockwise is to the right: y is negative.
    bytes[2] = bytes[102] = 9000 & 0xFF;
    bytes[3] = bytes[103] = 9000 >> 8;
    points.clear();
    PacketDecoder(hdl32e()).decode(DataPacket(bytes.data()), 0, 0, 0, points);
    QVERIFY(std::abs(points[0].x) < 1e-9 && std::abs(points[0].y + 5) < 1e-9);
}

void TestVelodyne::azimuthsAreInterpolated() {
    DataPacketWriter writer;
    for (int block = 0; block < blocksPerPacket; ++block) {
        writer.setAzimuth(block, std::uint16_t((35990 + 16 * block) % azimuthSteps));
        writer.setReturn(block, 15, 1000, 7);
    }
    std::vector<Point> points;
    const DataPacket packet(writer.bytes().data());
    for (int group = 0; group < blocksPerPacket; ++group)
        PacketDecoder(hdl32e()).decode(packet, group, 0, 1000, points);
    QCOMPARE(points.size(), std::size_t(12));
    QVERIFY(std::abs(points[0].azimuth - (359.90 + 0.16 * 0.375)) < 1e-9);
    QVERIFY(std::abs(points[1].azimuth - (0.06 + 0.16 * 0.375)) < 1e-9);
    QVERIFY(std::abs(points[11].azimuth - (1.66 + 0.16 * 0.375)) < 1e-9); // by the gap before it
    QCOMPARE(points[11].stamp_ns, std::int64_t(1000 + 11 * 46080 + 15 * 1152));
    writer.setAzimuth(1, 5000); // a jump is no gap
    QCOMPARE(azimuthGap(packet, 0), 0);
}

void TestVelodyne::aBlockOfAVlp16HoldsTwoFirings() {
    DataPacketWriter writer;
    for (int block = 0; block < blocksPerPacket; ++block)
        writer.setAzimuth(block, std::uint16_t((35970 + 40 * block) % azimuthSteps));
    writer.setReturn(0, 3, 1000, 1);   // laser 3 of the first firing
    writer.setReturn(0, 19, 2000, 2);  // and of the second
    writer.setReturn(11, 31, 3000, 3); // the last of all
    writer.setTail(0, ReturnMode::Last, Model::Vlp16);
    std::vector<Point> points;
    const DataPacket packet(writer.bytes().data());
    const PacketDecoder decoder(vlp16(), PacketDecoder::allLasers);
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

void TestVelodyne::ringsCountFromTheLowest() {
    QCOMPARE(hdl32e().ring(0), 0);
    QCOMPARE(hdl32e().ring(15), 23);
    QCOMPARE(hdl32e().ring(31), 31);
    QCOMPARE(vlp16().ring(0), 0);
    QCOMPARE(vlp16().ring(1), 8);
    QCOMPARE(vlp16().ring(15), 15);
}

void TestVelodyne::dualReturns_data() {
    QTest::addColumn<int>("returns");
    QTest::addColumn<bool>("same");
    QTest::addColumn<QVector<double>>("ranges");
    QTest::newRow("strongest") << int(Returns::Strongest) << false << QVector<double>{5.0};
    QTest::newRow("last") << int(Returns::Last) << false << QVector<double>{5.2};
    QTest::newRow("both") << int(Returns::Both) << false << QVector<double>{5.2, 5.0};
    QTest::newRow("both the same") << int(Returns::Both) << true << QVector<double>{5.0};
}

void TestVelodyne::dualReturns() {
    QFETCH(int, returns);
    QFETCH(bool, same);
    QFETCH(QVector<double>, ranges);
    Sensor sensor;
    sensor.dual = true;
    auto bytes = sensor.packet(0);
    const DataPacket packet(bytes.data());
    QCOMPARE(packet.groups(), 6);
    if (same)
        std::copy(bytes.begin() + 104, bytes.begin() + 200, bytes.begin() + 4);
    std::vector<Point> points;
    PacketDecoder(hdl32e(), horizonLaser, Returns(returns)).decode(packet, 0, 0, 0, points);
    QCOMPARE(int(points.size()), ranges.size());
    for (int i = 0; i < ranges.size(); ++i)
        QVERIFY(std::abs(points[std::size_t(i)].range - ranges[i]) < 1e-9);
    points.clear();
    PacketDecoder(hdl32e()).decode(packet, 5, 0, 0, points);
    QCOMPARE(points[0].stamp_ns, std::int64_t(5 * 46080 + 15 * 1152));
}

void TestVelodyne::stampsTakeTheHourOfTheReceiveTime_data() {
    QTest::addColumn<qint64>("receive_s");
    QTest::addColumn<qint64>("ofHour_s");
    QTest::addColumn<qint64>("stamp_s");
    const qint64 hour = 400000 * 3600LL;
    QTest::newRow("within the hour") << hour + 100 << 99LL << hour + 99;
    QTest::newRow("before the hour, received after") << hour + 1 << 3599LL << hour - 1;
    QTest::newRow("after the hour, received before") << hour - 1 << 1LL << hour + 1;
}

void TestVelodyne::stampsTakeTheHourOfTheReceiveTime() {
    QFETCH(qint64, receive_s);
    QFETCH(qint64, ofHour_s);
    QFETCH(qint64, stamp_s);
    StampClock clock;
    QCOMPARE(qint64(clock.absolute(std::uint32_t(ofHour_s * 1000000), receive_s * second_ns)),
             stamp_s * second_ns);
}

void TestVelodyne::stampsOfAFreeRunningSensorDoNotJump() {
    // Half an hour away from the host, where the nearest hour changes with every jitter; over two turns of
    // the hour.
    StampClock clock;
    const std::int64_t host = 400000 * hour_ns;
    std::int64_t last = 0;
    for (int i = 0; i < 9000; ++i) {
        const std::int64_t receive = host + i * second_ns + (i % 3) * 1000000;
        const std::int64_t stamp = clock.absolute(std::uint32_t((1800 + i) % 3600) * 1000000u, receive);
        QVERIFY(i == 0 || stamp - last == second_ns);
        last = stamp;
    }
}

/// The receiver's clock is 5 hours slow, or steps: the hour of the GPS counts, until it is released.
void TestVelodyne::aGpsTellsTheHour() {
    StampClock clock;
    const std::int64_t utc = 400000 * hour_ns + 3599 * second_ns, host = utc - 5 * hour_ns;
    QCOMPARE(clock.absolute(3599000000u, host), utc - 5 * hour_ns);
    clock.follow(utc);
    QCOMPARE(clock.absolute(3599000100u, host), utc + 100000);
    QCOMPARE(clock.absolute(100u, host + second_ns), utc + second_ns + 100000); // the hour begins anew
    QCOMPARE(clock.absolute(200u, host + 9 * hour_ns), utc + second_ns + 200000);
    clock.release(); // goes on in the same hour
    QCOMPARE(clock.absolute(300u, host + 9 * hour_ns + 100000), utc + second_ns + 300000);
}

void TestVelodyne::turnsBeginWhereTheAzimuthWraps() {
    Sensor sensor;
    std::vector<Turn> turns;
    TurnAssembler assembler({}, [&](const Turn &turn) { turns.push_back(turn); });
    for (int i = 0; i < 500; ++i)
        QCOMPARE(feed(assembler, sensor, i), PacketFault::None);
    assembler.finish();
    // 1000 hundredths to go at first: 59 firings; then 36000 / 17 = 2117.6 firings a turn.
    QCOMPARE(turns.size(), std::size_t(4));
    QVERIFY(turns[0].partial && !turns[1].partial && !turns[2].partial && turns[3].partial);
    QCOMPARE(turns[0].firings, 59u);
    QCOMPARE(turns[1].firings, 2118u);
    QCOMPARE(turns[0].firings + turns[1].firings + turns[2].firings + turns[3].firings, 6000u);
    for (const Turn &turn : turns) {
        QCOMPARE(turn.points.size(), std::size_t(turn.firings));
        QVERIFY(turn.begin_ns <= turn.points.front().stamp_ns && turn.points.back().stamp_ns < turn.end_ns);
        for (std::size_t i = 1; i < turn.points.size(); ++i)
            QVERIFY(turn.points[i].stamp_ns > turn.points[i - 1].stamp_ns);
    }
    QVERIFY(turns[1].points.front().azimuth < 0.5 && turns[1].points.back().azimuth > 359.5);
    QVERIFY(std::abs(turns[1].end_ns - turns[2].begin_ns) <= 1000);
    QVERIFY(std::abs(assembler.rpm() - 614.8) < 1);
    QCOMPARE(assembler.counts().lost, std::uint64_t(0));
    QCOMPARE(assembler.counts().packets, std::uint64_t(500));
}

void TestVelodyne::turnsOfAVlp16() {
    Sensor sensor;
    sensor.model = &vlp16();
    sensor.azimuthStep = 40;
    for (const bool dual : {false, true}) {
        sensor.dual = dual;
        std::vector<Turn> turns;
        TurnAssembler assembler({}, [&](const Turn &turn) { turns.push_back(turn); });
        for (int i = 0; i < (dual ? 400 : 200); ++i)
            QCOMPARE(feed(assembler, sensor, i), PacketFault::None);
        assembler.finish();
        QCOMPARE(assembler.model(), &vlp16());
        QCOMPARE(turns.size(), std::size_t(4)); // 25 blocks, 900, 900 and the rest of 2400
        QCOMPARE(turns[0].firings, 50u);
        QCOMPARE(turns[1].firings, 1800u);
        QVERIFY(!turns[1].partial && !turns[2].partial && turns[3].partial);
        QCOMPARE(turns[1].points.size(), std::size_t(1800)); // of laser 1
        QVERIFY(turns[1].points[7].laser == 1 && turns[1].model == &vlp16());
        QVERIFY(std::abs(assembler.rpm() - 602.8) < 0.1);
        QCOMPARE(assembler.counts().lost, std::uint64_t(0));
    }
}

void TestVelodyne::theFirstOfTwoSensorsIsDecoded() {
    Sensor hdl, vlp;
    vlp.model = &vlp16();
    std::vector<const SensorModel *> models;
    TurnAssembler assembler({}, [&](const Turn &turn) { models.push_back(turn.model); });
    for (int i = 0; i < 10; ++i) {
        QCOMPARE(feed(assembler, hdl, i), PacketFault::None);
        QCOMPARE(feed(assembler, vlp, i), PacketFault::Model);
    }
    QCOMPARE(assembler.counts().otherModel, std::uint64_t(10));
    vlp.start_ns += 2 * second_ns; // the first is switched off, the second stays
    for (int i = 0; i < 10; ++i)
        QCOMPARE(feed(assembler, vlp, i), PacketFault::None);
    assembler.finish();
    QVERIFY(models == (std::vector<const SensorModel *>{&hdl32e(), &hdl32e(), &vlp16(), &vlp16()}));
}

void TestVelodyne::aSettingNamesTheSensor() {
    Sensor sensor;
    TurnAssembler::Options options;
    options.model = Model::Vlp16;
    TurnAssembler assembler(options, [](const Turn &) {});
    QCOMPARE(feed(assembler, sensor, 0), PacketFault::Model);
    auto blank = sensor.packet(1); // old firmware names neither mode nor model
    blank[1204] = blank[1205] = 0;
    QCOMPARE(assembler.feed(blank.data(), blank.size(), sensor.stamp(1)), PacketFault::None);
    QCOMPARE(assembler.model(), &vlp16());
}

void TestVelodyne::everyNthFiringOnly() {
    Sensor sensor;
    TurnAssembler::Options options;
    options.laser = PacketDecoder::allLasers;
    options.firingStep = 8;
    std::vector<Turn> turns;
    TurnAssembler assembler(options, [&](const Turn &turn) { turns.push_back(turn); });
    for (int i = 0; i < 300; ++i)
        feed(assembler, sensor, i);
    QCOMPARE(turns.at(1).firings, 2118u);
    QCOMPARE(turns.at(1).points.size(), std::size_t(32 * 265)); // 0, 8, ... 2112
    const std::int64_t step_ns = turns[1].points[32].stamp_ns - turns[1].points[0].stamp_ns;
    QVERIFY(std::abs(step_ns - 8 * firingPeriod_ns) < 1000); // stamps are whole microseconds
}

void TestVelodyne::aJumpIsNoLoss() {
    Sensor sensor;
    std::vector<std::uint64_t> numbers;
    TurnAssembler assembler({}, [&](const Turn &turn) {
        QVERIFY(turn.partial);
        numbers.push_back(turn.number);
    });
    feed(assembler, sensor, 0);
    assembler.jump();
    feed(assembler, sensor, 1000);
    assembler.jump();
    feed(assembler, sensor, 0);
    assembler.finish();
    QCOMPARE(numbers, (std::vector<std::uint64_t>{0, 1, 2}));
    const PacketCounts &counts = assembler.counts();
    QCOMPARE(counts.lost + counts.outOfOrder + counts.clockJumps, std::uint64_t(0));
}

void TestVelodyne::lossesAreCounted() {
    Sensor sensor;
    std::uint64_t lostInTurns = 0;
    TurnAssembler assembler({}, [&](const Turn &turn) { lostInTurns += turn.lostPackets; });
    for (int i = 0; i < 1000; ++i) {
        if (i != 5 && i != 7 && i != 8 && !(i >= 100 && i < 120))
            feed(assembler, sensor, i);
    }
    assembler.finish();
    QCOMPARE(assembler.counts().packets, std::uint64_t(977));
    QCOMPARE(assembler.counts().lost, std::uint64_t(23));
    QCOMPARE(assembler.counts().gaps, std::uint64_t(3));
    QCOMPARE(lostInTurns, std::uint64_t(23));
}

void TestVelodyne::latePacketsAreCountedAndLeftOut() {
    Sensor sensor;
    std::size_t points = 0;
    TurnAssembler assembler({}, [&](const Turn &turn) { points += turn.points.size(); });
    for (const int i : {0, 1, 3, 2, 4, 4, 5})
        feed(assembler, sensor, i);
    assembler.finish();
    QCOMPARE(assembler.counts().outOfOrder, std::uint64_t(2));
    QCOMPARE(assembler.counts().lost, std::uint64_t(1));
    QCOMPARE(points, std::size_t(5 * blocksPerPacket));
}

void TestVelodyne::aLongGapCutsTheTurn() {
    Sensor sensor;
    std::vector<bool> partial;
    TurnAssembler assembler({}, [&](const Turn &turn) { partial.push_back(turn.partial); });
    for (int i = 0; i < 1000; ++i) {
        if (i < 300 || i >= 300 + 177) // a whole turn is missing: the azimuth alone would not show it
            feed(assembler, sensor, i);
    }
    QCOMPARE(partial, (std::vector<bool>{true, false, true, true, false, false}));
}

void TestVelodyne::aClockJumpIsNoLoss() {
    Sensor sensor;
    TurnAssembler assembler({}, [](const Turn &) {});
    for (int i = 0; i < 10; ++i)
        feed(assembler, sensor, i);
    Sensor restarted;
    restarted.start_ns = sensor.start_ns + 600 * second_ns;
    for (int i = 0; i < 10; ++i) {
        const auto bytes = restarted.packet(i);
        assembler.feed(bytes.data(), bytes.size(), sensor.stamp(10 + i));
    }
    QCOMPARE(assembler.counts().clockJumps, std::uint64_t(1));
    QCOMPARE(assembler.counts().lost, std::uint64_t(0));
}

void TestVelodyne::aHeadThatStandsStillDoesNotFillTheMemory() {
    Sensor sensor;
    sensor.azimuthStep = 0;
    std::vector<std::uint32_t> firings;
    TurnAssembler assembler({}, [&](const Turn &turn) {
        QVERIFY(turn.partial);
        firings.push_back(turn.firings);
    });
    for (int i = 0; i < 4000; ++i)
        feed(assembler, sensor, i);
    QCOMPARE(firings, (std::vector<std::uint32_t>{21701, 21701}));
}

/// Two packets 1 us apart: a turn begins with the last firing of the one and ends with the first of the
/// other.
void TestVelodyne::turnsThatEndBeforeTheyBeginHaveNoSpeed() {
    int turns = 0;
    TurnAssembler assembler({}, [&turns](const Turn &) { ++turns; });
    for (int number = 0; number < 2; ++number) {
        DataPacketWriter writer;
        const int wrap = number == 0 ? blocksPerPacket - 1 : 1;
        for (int block = 0; block < blocksPerPacket; ++block)
            writer.setAzimuth(block, block < wrap ? 35000 : 100);
        writer.setTail(std::uint32_t(1000 + number));
        QCOMPARE(assembler.feed(writer.bytes().data(), packetSize, number * 1000), PacketFault::None);
    }
    QCOMPARE(turns, 2);
    QCOMPARE(assembler.rpm(), 0.0);
}

void TestVelodyne::randomBytesDoNoHarm() {
    const unsigned seed = std::random_device()();
    qInfo("seed %u", seed);
    std::mt19937 random(seed);
    TurnAssembler::Options options;
    options.laser = PacketDecoder::allLasers;
    options.returns = Returns::Both;
    TurnAssembler assembler(options, [](const Turn &turn) {
        for (const Point &point : turn.points)
            QVERIFY(std::isfinite(point.x) && point.azimuth >= 0 && point.azimuth < 360);
    });
    std::vector<std::uint8_t> bytes;
    for (int round = 0; round < 20000; ++round) {
        bytes.resize(round % 4 ? packetSize : random() % 2000);
        for (std::uint8_t &byte : bytes)
            byte = std::uint8_t(random());
        if (round % 4 > 1) { // as like a packet as it can be
            for (int block = 0; block < blocksPerPacket; ++block) {
                bytes[block * blockSize] = 0xFF;
                bytes[block * blockSize + 1] = 0xEE;
                bytes[block * blockSize + 3] %= 0x8C;
            }
            bytes[1203] %= 0xD6;
            bytes[1204] = std::uint8_t(0x37 + random() % 3);
            bytes[1205] = std::uint8_t(0x21 + random() % 2);
        }
        assembler.feed(bytes.data(), bytes.size(), std::int64_t(random()) * 1000000000);
    }
    assembler.finish();
    const PacketCounts &counts = assembler.counts();
    QCOMPARE(counts.packets, std::uint64_t(20000));
    QVERIFY(counts.wrongSize > 4000 && counts.wrongFlag > 4000);
}

QTEST_APPLESS_MAIN(TestVelodyne)
#include "TestVelodyne.moc"
