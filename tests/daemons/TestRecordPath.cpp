#include "daemons/velodynelogger/DatagramRing.h"
#include "daemons/velodynelogger/PacketAccount.h"
#include "daemons/velodynelogger/PcapFiles.h"
#include "tests/support/AllocationCounter.h"
#include "tests/support/Sensor.h"

using namespace hermes;
using namespace hermes::velodynelogger;

/// The way of a packet from the receiver to the file, in one thread, so that its allocations can be counted.
class TestRecordPath : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void aPacketCostsNoAllocation() {
        QTemporaryDir folder;
        const Sensor sensor;
        const QByteArray position(512, 'p');
        DatagramRing ring(100000);
        PacketAccount account;
        PcapFiles files;
        QVERIFY(files.open({folder.path(), "velodynelogger", 1e9, 3600}));
        const auto record = [&](const Datagram &pushed) {
            QVERIFY(ring.push(pushed));
            ring.wake();
            Datagram datagram;
            QVERIFY(ring.front(datagram));
            account.add(datagram);
            QVERIFY(files.write(datagram));
            ring.pop();
        };
        const auto recordAll = [&](int first, int end) {
            for (int i = first; i < end; ++i) {
                const auto packet = sensor.packet(i);
                record(sensorDatagram(packet, sensor.stamp(i)));
                if (i % 14 == 0)
                    record(sensorDatagram(position, sensor.stamp(i)));
            }
            QVERIFY(files.flush());
        };
        recordAll(0, 100);
        const std::size_t before = allocations;
        recordAll(100, 2000);
        QCOMPARE(allocations - before, std::size_t(0));
        QCOMPARE(account.counts().packets, std::uint64_t(2000 + 143));
    }
};
