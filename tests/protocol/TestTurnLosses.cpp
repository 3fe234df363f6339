// Turns of packets that are missing, late, or of another time.
#include "TurnFeed.h"

using namespace hermes::velodyne;

class TestTurnLosses : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void aJumpIsNoLoss() {
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

    void lossesAreCounted() {
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

    void latePacketsAreCountedAndLeftOut() {
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

    void aLongGapCutsTheTurn() {
        Sensor sensor;
        std::vector<bool> partial;
        TurnAssembler assembler({}, [&](const Turn &turn) { partial.push_back(turn.partial); });
        for (int i = 0; i < 1000; ++i) {
            if (i < 300 || i >= 300 + 177) // a whole turn is missing: the azimuth alone would not show it
                feed(assembler, sensor, i);
        }
        QCOMPARE(partial, (std::vector<bool>{true, false, true, true, false, false}));
    }

    void aClockJumpIsNoLoss() {
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

    void aHeadThatStandsStillDoesNotFillTheMemory() {
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
};
