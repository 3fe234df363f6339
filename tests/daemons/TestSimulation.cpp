#include "Pillars.h"
#include "daemons/simulator/PacketPump.h"
#include "protocol/velodyne/TurnAssembler.h"

using namespace hermes;
using namespace hermes::simulator;

static constexpr std::int64_t start_ns = 1700000000000000000;

static double processorSeconds() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + now.tv_nsec * 1e-9;
}

class TestSimulation : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void drivesThePathOnce() {
        World world = pillars();
        world.poses.resize(4);
        Simulation simulation(world, {}, start_ns);
        QVERIFY(!simulation.truth().driving && !simulation.truth().finished);
        QVERIFY(simulation.drive());
        for (int i = 0; i < 10 * 1808 && !simulation.truth().finished; ++i)
            simulation.nextPacket();
        QVERIFY(simulation.truth().finished && !simulation.truth().driving);
        QCOMPARE(simulation.truth().progress, 1.0);
        QCOMPARE(simulation.truth().pose.x, world.poses.back().x);
        QVERIFY(!simulation.drive());
        simulation.restart();
        QCOMPARE(simulation.truth().pose.x, world.poses.front().x);
        QVERIFY(simulation.drive());
    }

    void placing() {
        Simulation simulation(pillars(), {}, start_ns);
        simulation.place({3, 4, 1});
        simulation.nextPacket();
        QCOMPARE(simulation.truth().pose.y, 4.0);
        QVERIFY(!simulation.drive());
        simulation.restart();
        QVERIFY(simulation.drive());
    }

    void packetsAreSentAtTheirRate() {
        if (slowness > 5)
            QSKIP("1808 packets a second need real time, which an emulator (HERMES_SLOWNESS) does not have");
        QUdpSocket receiver;
        QVERIFY(receiver.bind(QHostAddress(QHostAddress::LocalHost), 0));
        receiver.setSocketOption(QAbstractSocket::ReceiveBufferSizeSocketOption, 4 << 20);
        std::atomic<int> truths{0};
        std::atomic<std::int64_t> lastTruth_ns{0};
        PacketPump pump([&](const Simulation::Truth &truth) {
            ++truths;
            lastTruth_ns = truth.stamp_ns;
        });
        const double processor = processorSeconds();
        auto timer = runningTimer();
        QVERIFY(pump.start(pillars(), {}, "127.0.0.1", receiver.localPort()));
        std::size_t turns = 0;
        velodyne::TurnAssembler assembler({}, [&](const velodyne::Turn &turn) {
            QVERIFY(turns == 0 || std::abs(double(turn.points.size()) - 2170) < 3);
            ++turns;
        });
        QByteArray bytes(2000, '\0');
        while (turns < 21 && timer.elapsed() < 20000) {
            receiver.waitForReadyRead(100);
            while (receiver.hasPendingDatagrams()) {
                const qint64 size = receiver.readDatagram(bytes.data(), bytes.size());
                const std::int64_t now_ns = std::int64_t(QDateTime::currentMSecsSinceEpoch()) * 1000000;
                assembler.feed(reinterpret_cast<const std::uint8_t *>(bytes.constData()), std::size_t(size),
                               now_ns);
            }
        }
        pump.stop();
        const double seconds = timer.nsecsElapsed() * 1e-9;
        const PacketPump::Counts counts = pump.counts();
        qInfo("%.1f packets a second, worst lag %.1f ms, processor %.1f %%", double(counts.sent) / seconds,
              counts.worstLag_s * 1e3, 100 * (processorSeconds() - processor) / seconds);
        QCOMPARE(turns, std::size_t(21));
        // It ended as late as a busy machine had made it.
        const double lag = counts.worstLag_s / seconds;
        QVERIFY(std::abs(double(counts.sent) / seconds - 1808.45) < 30 + 1808 * lag);
        QCOMPARE(assembler.counts().lost + assembler.counts().outOfOrder, std::uint64_t(0));
        QCOMPARE(counts.skipped + counts.sendErrors + counts.swallowed, std::uint64_t(0));
        QVERIFY(std::abs(truths / seconds - 50) < 2 + 50 * lag);
        QVERIFY(std::abs(double(lastTruth_ns) * 1e-6 - double(QDateTime::currentMSecsSinceEpoch())) < 1000);
    }

    void pumpRefusesBadAddresses() {
        PacketPump pump([](const Simulation::Truth &) {});
        QCOMPARE(pump.start(pillars(), {}, "nowhere", 2368).error(),
                 std::string("nowhere: an IPv4 address such as 127.0.0.1 expected"));
        bool ran = false;
        pump.with([&](Simulation &) { ran = true; });
        QVERIFY(!ran);
    }

    void faultsSwallowPackets() {
        QUdpSocket receiver;
        QVERIFY(receiver.bind(QHostAddress(QHostAddress::LocalHost), 0));
        PacketPump pump([](const Simulation::Truth &) {});
        pump.setFault({LidarFault::Kind::Silence, 0});
        QVERIFY(pump.start(pillars(), {}, "127.0.0.1", receiver.localPort()));
        QTRY_VERIFY(pump.counts().swallowed > 50);
        QVERIFY(!receiver.hasPendingDatagrams());
        QCOMPARE(pump.counts().sent, std::uint64_t(0));
        pump.setFault({LidarFault::Kind::Loss, 0.5});
        QTRY_VERIFY(pump.counts().sent > 500);
        pump.setFault({});
        const auto swallowed = pump.counts().swallowed;
        QVERIFY(swallowed > 300);
        const auto sent = pump.counts().sent;
        QTRY_VERIFY(pump.counts().sent > sent + 50);
        QCOMPARE(pump.counts().swallowed, swallowed);
    }
};
