#include "TurnFeed.h"

using namespace hermes::velodyne;

class TestTurnAssembler : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void turnsBeginWhereTheAzimuthWraps() {
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
            QVERIFY(turn.begin_ns <= turn.points.front().stamp_ns &&
                    turn.points.back().stamp_ns < turn.end_ns);
            for (std::size_t i = 1; i < turn.points.size(); ++i)
                QVERIFY(turn.points[i].stamp_ns > turn.points[i - 1].stamp_ns);
        }
        QVERIFY(turns[1].points.front().azimuth < 0.5 && turns[1].points.back().azimuth > 359.5);
        QVERIFY(std::abs(turns[1].end_ns - turns[2].begin_ns) <= 1000);
        QVERIFY(std::abs(assembler.rpm() - 614.8) < 1);
        QCOMPARE(assembler.counts().lost, std::uint64_t(0));
        QCOMPARE(assembler.counts().packets, std::uint64_t(500));
    }

    void turnsOfAVlp16() {
        Sensor sensor;
        sensor.model = &vlp16;
        sensor.azimuthStep = 40;
        for (const bool dual : {false, true}) {
            sensor.dual = dual;
            std::vector<Turn> turns;
            TurnAssembler assembler({}, [&](const Turn &turn) { turns.push_back(turn); });
            for (int i = 0; i < (dual ? 400 : 200); ++i)
                QCOMPARE(feed(assembler, sensor, i), PacketFault::None);
            assembler.finish();
            QCOMPARE(assembler.model(), &vlp16);
            QCOMPARE(turns.size(), std::size_t(4)); // 25 blocks, 900, 900 and the rest of 2400
            QCOMPARE(turns[0].firings, 50u);
            QCOMPARE(turns[1].firings, 1800u);
            QVERIFY(!turns[1].partial && !turns[2].partial && turns[3].partial);
            QCOMPARE(turns[1].points.size(), std::size_t(1800)); // of laser 1
            QVERIFY(turns[1].points[7].laser == 1 && turns[1].model == &vlp16);
            QVERIFY(std::abs(assembler.rpm() - 602.8) < 0.1);
            QCOMPARE(assembler.counts().lost, std::uint64_t(0));
        }
    }

    void theFirstOfTwoSensorsIsDecoded() {
        Sensor hdl, vlp;
        vlp.model = &vlp16;
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
        QVERIFY(models == (std::vector<const SensorModel *>{&hdl32e, &hdl32e, &vlp16, &vlp16}));
    }

    void aSettingNamesTheSensor() {
        Sensor sensor;
        TurnAssembler::Options options;
        options.model = Model::Vlp16;
        TurnAssembler assembler(options, [](const Turn &) {});
        QCOMPARE(feed(assembler, sensor, 0), PacketFault::Model);
        auto blank = sensor.packet(1); // old firmware names neither mode nor model
        blank[1204] = blank[1205] = 0;
        QCOMPARE(assembler.feed(blank.data(), blank.size(), sensor.stamp(1)), PacketFault::None);
        QCOMPARE(assembler.model(), &vlp16);
    }

    void everyNthFiringOnly() {
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
        QVERIFY(std::abs(step_ns - 8 * hdl32e.firingPeriod_ns) < 1000); // stamps are whole microseconds
    }

    void beamsOfAllLasersAreCounted_data() { falseAndTrue("dual", "single", "dual"); }

    /// Whichever laser is decoded; the second return of a beam does not count.
    void beamsOfAllLasersAreCounted() {
        QFETCH(bool, dual);
        Sensor sensor;
        sensor.dual = dual;
        sensor.model = &vlp16;
        sensor.azimuthStep = 40;
        for (const std::uint32_t back : {0u, 3u, 32u}) { // of the slots of a block
            std::vector<Turn> turns;
            TurnAssembler assembler({}, [&](const Turn &turn) { turns.push_back(turn); });
            for (int i = 0; i < (dual ? 200 : 100); ++i) {
                auto bytes = sensor.packet(i);
                for (std::size_t block = 0; block < blocksPerPacket; ++block)
                    for (std::size_t slot = back; slot < slotsPerBlock; ++slot)
                        bytes[block * blockSize + 4 + 3 * slot] = bytes[block * blockSize + 5 + 3 * slot] = 0;
                assembler.feed(bytes.data(), bytes.size(), sensor.stamp(i) + 200000);
            }
            QVERIFY(turns.size() >= 2);
            const std::uint32_t counted = (turns[1].firings / 2 + 7) / 8; // blocks
            QCOMPARE(turns[1].beams, 32 * counted);
            QCOMPARE(turns[1].beamsBack, counted * back);
        }
    }

    /// Two packets 1 us apart: a turn begins with the last firing of the one and ends with the first of the
    /// other.
    void turnsThatEndBeforeTheyBeginHaveNoSpeed() {
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

    void randomBytesDoNoHarm() {
        std::mt19937 random(newSeed());
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
};
