#include "daemons/velodynelogger/DatagramRing.h"
#include "daemons/velodynelogger/PacketAccount.h"
#include "tests/support/Sensor.h"

using namespace hermes;
using namespace hermes::velodynelogger;

class TestPacketAccount : public QObject {
    Q_OBJECT

    /// Counts of the packets with these numbers, in this order.
    static PacketAccount::Counts countsOf(const Sensor &sensor, const std::vector<int> &numbers) {
        PacketAccount account;
        for (const int number : numbers)
            account.add(sensorDatagram(sensor.packet(number), sensor.stamp(number)));
        return account.counts();
    }

    template <typename Bytes>
    static PacketAccount::Counts countsOfPayload(const Bytes &payload) {
        PacketAccount account;
        account.add(sensorDatagram(payload, 1));
        return account.counts();
    }

private Q_SLOTS:
    void missingPacketsAreCounted_data() {
        const Rows<std::vector<int>, int, int> row("numbers", "missing", "late");
        row("none", {0, 1, 2, 3}, 0, 0);
        row("one", {0, 1, 3}, 1, 0);
        row("many", {0, 20001, 20002}, 20000, 0);
        row("swapped", {0, 2, 1, 3}, 0, 1);
        row("twice", {0, 1, 1, 2}, 0, 1);
        row("lost and twice", {0, 2, 2, 3}, 1, 1);
    }

    void missingPacketsAreCounted() {
        FETCH(std::vector<int>, numbers, int, missing, int, late);
        for (const bool dual : {false, true}) {
            Sensor sensor;
            sensor.dual = dual;
            sensor.start_ns += 3599999000000; // the hour of the stamps wraps
            const PacketAccount::Counts counts = countsOf(sensor, numbers);
            QCOMPARE(counts.packets, std::uint64_t(numbers.size()));
            QCOMPARE(counts.data, std::uint64_t(numbers.size()));
            QCOMPARE(counts.missing, std::uint64_t(missing));
            QCOMPARE(counts.late, std::uint64_t(late));
        }
    }

    void everyKindIsCountedOnce() {
        const Sensor sensor;
        auto vlp16 = sensor.packet(0), unknown = vlp16, flag = vlp16;
        vlp16[1205] = 0x22;
        unknown[1205] = 0x7F;
        flag[100] = 0;
        QCOMPARE(countsOfPayload(vlp16).data, std::uint64_t(1));
        QCOMPARE(countsOfPayload(unknown).other, std::uint64_t(1));
        QCOMPARE(countsOfPayload(flag).other, std::uint64_t(1));
        QCOMPARE(countsOfPayload(QByteArray(512, 'p')).position, std::uint64_t(1));
        QCOMPARE(countsOfPayload(QByteArray()).other, std::uint64_t(1));
        QCOMPARE(countsOfPayload(QByteArray(1205, 'x')).other, std::uint64_t(1));
    }

    void clocksThatJump() {
        const Sensor sensor;
        PacketAccount account;
        const auto add = [&](int number, std::int64_t stamp_ns) {
            account.add(sensorDatagram(sensor.packet(number), stamp_ns));
        };
        const std::int64_t hour_ns = 3600000000000;
        add(0, sensor.stamp(0));
        add(1, sensor.stamp(1) - hour_ns); // the host's clock was set back: nothing is missing
        add(2, sensor.stamp(2) - hour_ns);
        QCOMPARE(account.counts().hostClockSteps, std::uint64_t(1));
        QCOMPARE(account.counts().sensorClockJumps, std::uint64_t(0));
        add(3000000, sensor.stamp(3) - hour_ns); // the sensor was switched on again
        add(3000001, sensor.stamp(4) - hour_ns);
        QCOMPARE(account.counts().sensorClockJumps, std::uint64_t(1));
        add(2000000, sensor.stamp(5) - 2 * hour_ns); // both clocks went back
        add(2000001, sensor.stamp(6) - 2 * hour_ns);
        QCOMPARE(account.counts().sensorClockJumps, std::uint64_t(2));
        QCOMPARE(account.counts().hostClockSteps, std::uint64_t(2));
        QCOMPARE(account.counts().missing, std::uint64_t(0));
    }

    void stampsThatAreTooCloseMissNothing() {
        const Sensor sensor;
        PacketAccount account;
        for (int i = 0; i < 1000; ++i) {
            velodyne::DataPacketWriter packet;
            packet.setTail(std::uint32_t(i * 7));
            account.add(sensorDatagram(packet.bytes(), sensor.stamp(i)));
        }
        QCOMPARE(account.counts().missing, std::uint64_t(0));
    }

    void ofTwoSensorsTheFirstIsFollowed() {
        Sensor first, second;
        second.start_ns += 1234567890;
        PacketAccount account;
        for (int i = 0; i < 10; ++i) {
            account.add(sensorDatagram(first.packet(i), first.stamp(i)));
            const auto packet = second.packet(i);
            Datagram datagram = sensorDatagram(packet, first.stamp(i));
            ++datagram.source;
            account.add(datagram);
        }
        QCOMPARE(account.counts().data, std::uint64_t(20));
        QCOMPARE(account.counts().missing + account.counts().late + account.counts().sensorClockJumps,
                 std::uint64_t(0));
    }

    void ringKeepsOrderAndContent() {
        const unsigned seed = 7;
        DatagramRing ring(20000);
        constexpr int count = 100000;
        std::thread reader([&ring] {
            std::mt19937 random(seed);
            Datagram datagram;
            for (int i = 0; i < count; ++i) {
                while (!ring.front(datagram))
                    ring.wait(std::chrono::milliseconds(100));
                const std::vector<std::uint8_t> expected(random() % 2049, std::uint8_t(i));
                if (datagram.stamp_ns != i || datagram.size != expected.size() ||
                    !std::equal(expected.begin(), expected.end(), datagram.payload))
                    qFatal("datagram %d of seed %u is not what was pushed", i, seed);
                ring.pop();
            }
        });
        std::mt19937 random(seed);
        for (int i = 0; i < count; ++i) {
            const std::vector<std::uint8_t> payload(random() % 2049, std::uint8_t(i));
            while (!ring.push(sensorDatagram(payload, i)))
                std::this_thread::yield();
            ring.wake();
        }
        reader.join();
        QCOMPARE(ring.used(), std::size_t(0));
    }

    void ringIsBounded() {
        DatagramRing ring(10000);
        const QByteArray payload(1206, 'x');
        int taken = 0;
        while (ring.push(sensorDatagram(payload, taken)))
            ++taken;
        QCOMPARE(taken, 7); // of 1280 bytes each
        QVERIFY(ring.used() <= ring.capacity());
        Datagram datagram;
        for (int i = 0; i < taken; ++i) {
            QVERIFY(ring.front(datagram));
            QCOMPARE(datagram.stamp_ns, std::int64_t(i));
            ring.pop();
        }
        QVERIFY(!ring.front(datagram));
        QVERIFY(!ring.push(sensorDatagram(QByteArray(20000, 'x'), 0)));
        ring.interrupt();
        ring.wait(std::chrono::hours(1)); // ends at once
    }
};
