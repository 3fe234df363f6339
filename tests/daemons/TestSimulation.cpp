#include "common/world/WorldFile.h"
#include "daemons/simulator/PacketPump.h"
#include "protocol/velodyne/TurnAssembler.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <QElapsedTimer>
#include <QUdpSocket>
#include <QtTest>

#include <ctime>

using namespace hermes;
using vectorlib::LineSegment2D;
using vectorlib::Transformation2D;
using Point = vectorlib::Vector2D<double>;

namespace {

constexpr std::int64_t start_ns = 1700000000000000000;

World pillars() {
    std::string error;
    const auto world =
        readWorld(qEnvironmentVariable("HERMES_SOURCE").toStdString() + "/deploy/worlds/pillars.json", error);
    if (!world)
        qFatal("%s", error.c_str());
    return *world;
}

double distanceToWalls(const World &world, Point p) {
    double nearest = 1e9;
    for (const World::Edge &e : world.edges)
        nearest = std::min(nearest, LineSegment2D<double>({e.x1, e.y1}, {e.x2, e.y2}).distance(p));
    return nearest;
}

double processorSeconds() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + now.tv_nsec * 1e-9;
}

} // namespace

class TestSimulation : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void pathPassesThroughThePoses();
    void pathKeepsItsLimits();
    void pathTurnsTheShorterWay();
    void followerStandsDrivesAndStops();
    void followerHaltsSmoothly();
    void ringPointsLieOnTheWalls_data();
    void ringPointsLieOnTheWalls();
    void lasersMeetWallsFloorOrNothing();
    void rangesOutOfReachReturnNothing();
    void rangesAreQuantised();
    void returnsDropOutAndLieFar();
    void sameSeedSamePackets();
    void drivesThePathOnce();
    void placing();
    void packetsAreSentAtTheirRate();
    void pumpRefusesBadAddresses();
    void faultsSwallowPackets();
};

void TestSimulation::pathPassesThroughThePoses() {
    const World world = pillars();
    const PosePath path(world.poses, 0.8, 1);
    QVERIFY(path.length() > 25.4 / 0.8 && path.length() < 40);
    const auto first = path.poseAt(-1), last = path.poseAt(path.length() + 1);
    QCOMPARE(first.x, world.poses.front().x);
    QCOMPARE(last.x, world.poses.back().x);
    for (const World::Pose &pose : world.poses) {
        double nearest = 1e9, heading = 0;
        for (double p = 0; p < path.length(); p += 0.002) {
            const auto at = path.poseAt(p);
            const double distance = std::hypot(at.x - pose.x, at.y - pose.y);
            heading = distance < nearest ? at.theta : heading;
            nearest = std::min(nearest, distance);
        }
        QVERIFY(nearest < 0.002);
        QVERIFY(std::abs(vectorlib::wrapAngle(heading - pose.theta)) < 0.01);
    }
}

void TestSimulation::pathKeepsItsLimits() {
    const World world = pillars();
    const PosePath path(world.poses, 0.8, 0.5);
    const double step = 0.01;
    for (double p = 0; p + step < path.length(); p += step) {
        const auto a = path.poseAt(p), b = path.poseAt(p + step);
        QVERIFY(std::hypot(b.x - a.x, b.y - a.y) < 0.8 * step * 1.001);
        QVERIFY(std::abs(vectorlib::wrapAngle(b.theta - a.theta)) < 0.5 * step * 1.001);
        const Twist twist = path.twistAt(p, 1);
        QVERIFY(std::hypot(twist.vx, twist.vy) <= 0.8 * 1.001 && std::abs(twist.omega) <= 0.5 * 1.001);
        QVERIFY(distanceToWalls(world, {a.x, a.y}) > 0.35);
    }
}

void TestSimulation::pathTurnsTheShorterWay() {
    const PosePath path({{0, 0, 3}, {1, 0, -3}, {1, 0, -3}, {1, 0, 3}}, 1, 1);
    for (double p = 0; p < path.length(); p += 0.01)
        QVERIFY(std::abs(path.poseAt(p).theta) > 2.9);
    QVERIFY(PosePath({}, 1, 1).isEmpty());
    QCOMPARE(PosePath({{1, 2, 3}}, 1, 1).length(), 0.0);
    QCOMPARE(PosePath({{1, 2, 3}}, 1, 1).poseAt(5).y, 2.0);
}

void TestSimulation::followerStandsDrivesAndStops() {
    PathFollower follower(PosePath({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}, 1, 1), 0.5);
    follower.advance(1);
    QCOMPARE(follower.pose().x, 0.0);
    follower.drive();
    double last = 0, lastRate = 0, seconds = 0;
    while (follower.isDriving() && seconds < 20) {
        follower.advance(0.001);
        seconds += 0.001;
        QVERIFY(follower.pose().x >= last);
        QVERIFY(follower.pose().x - last <= 0.001 * 1.0001);
        QVERIFY(std::abs(follower.rate() - lastRate) < 0.0012 || follower.isFinished());
        last = follower.pose().x;
        lastRate = follower.rate();
    }
    QVERIFY(follower.isFinished());
    QCOMPARE(follower.pose().x, 4.0);
    QVERIFY(seconds > 5.9 && seconds < 6.2); // 4 m at 1 m/s and 2 s for speeding up and braking
    QCOMPARE(follower.rate(), 0.0);
}

void TestSimulation::followerHaltsSmoothly() {
    PathFollower follower(PosePath({{0, 0, 0}, {10, 0, 0}}, 1, 1), 0.5);
    follower.drive();
    for (int i = 0; i < 4000; ++i)
        follower.advance(0.001);
    QVERIFY(std::abs(follower.twist().vx - 1) < 1e-6);
    const double from = follower.pose().x;
    follower.halt();
    for (int i = 0; i < 4000; ++i)
        follower.advance(0.001);
    QVERIFY(std::abs(follower.pose().x - from - 1) < 0.01); // v^2 / 2a
    QVERIFY(!follower.isDriving() && follower.rate() == 0 && !follower.isFinished());
}

void TestSimulation::ringPointsLieOnTheWalls_data() {
    QTest::addColumn<bool>("driving");
    QTest::addColumn<double>("sigma");
    QTest::newRow("standing, no noise") << false << 0.0;
    QTest::newRow("standing") << false << 0.01;
    QTest::newRow("driving, no noise") << true << 0.0;
    QTest::newRow("driving") << true << 0.01;
}

void TestSimulation::ringPointsLieOnTheWalls() {
    QFETCH(bool, driving);
    QFETCH(double, sigma);
    const World world = pillars();
    Simulation::Options options;
    options.lidar.sigma = sigma;
    Simulation simulation(world, options, start_ns);
    // An equal one that only moves tells where the robot was when a point was taken.
    PathFollower truth(PosePath(world.poses, options.speed, options.turnRate),
                       options.acceleration / options.speed);
    if (driving) {
        QVERIFY(simulation.drive());
        truth.drive();
    }
    std::int64_t truthTime_ns = start_ns;
    std::size_t points = 0, far = 0;
    double squares = 0;
    velodyne::TurnAssembler assembler({}, [&](const velodyne::Turn &turn) {
        for (const velodyne::Point &point : turn.points) {
            for (; truthTime_ns + velodyne::firingPeriod_ns < point.stamp_ns;
                 truthTime_ns += velodyne::firingPeriod_ns)
                truth.advance(velodyne::firingPeriod_ns * 1e-9);
            const double distance =
                distanceToWalls(world, Transformation2D(truth.pose()) * Point(point.x, point.y));
            ++points;
            squares += distance * distance;
            // Stamps are whole microseconds, azimuths hundredths of a degree, ranges 2 mm.
            far += distance > 4 * sigma + 0.004;
        }
    });
    for (int i = 0; i < 4 * 1808; ++i)
        assembler.feed(simulation.nextPacket().data(), velodyne::packetSize, simulation.now_ns());
    QCOMPARE(assembler.counts().lost + assembler.counts().outOfOrder, std::uint64_t(0));
    QVERIFY(points > 80000);
    QVERIFY2(far <= points * 2e-4, qPrintable(QString::number(far)));
    QVERIFY(std::sqrt(squares / double(points)) < sigma + 0.001);
    QVERIFY(sigma == 0 || std::sqrt(squares / double(points)) > sigma / 3);
    QVERIFY(std::abs(assembler.rpm() - 600) < 0.5);
}

void TestSimulation::lasersMeetWallsFloorOrNothing() {
    World world = pillars();
    world.edges.resize(4);
    world.poses = {{4, 3, 0}};
    Simulation::Options options;
    options.lidar.sigma = 0;
    Simulation simulation(world, options, start_ns);
    int walls = 0, floors = 0;
    std::array<int, velodyne::lasers> ofLaser{};
    velodyne::TurnAssembler::Options all;
    all.laser = velodyne::PacketDecoder::allLasers;
    velodyne::TurnAssembler assembler(all, [&](const velodyne::Turn &turn) {
        for (const velodyne::Point &p : turn.points) {
            const bool floor = std::abs(p.z + options.lidar.sensorHeight) < 0.003;
            const bool wall = distanceToWalls(world, {4 + p.x, 3 + p.y}) < 0.006;
            QVERIFY(floor || wall);
            QVERIFY(p.z < options.lidar.wallHeight - options.lidar.sensorHeight + 0.003);
            (floor ? floors : walls)++;
            ++ofLaser[p.laser];
        }
    });
    for (int i = 0; i < 182; ++i)
        assembler.feed(simulation.nextPacket().data(), velodyne::packetSize, start_ns);
    assembler.finish();
    QVERIFY(walls > 10000 && floors > 10000);
    QCOMPARE(ofLaser[0], 182 * 12);

    options.lidar.wallHeight = 0.4; // lower than the sensor: the horizon is free
    simulation = Simulation(world, options, start_ns);
    const velodyne::DataPacket packet(simulation.nextPacket().data());
    QCOMPARE(int(packet.distance(0, velodyne::horizonLaser)), 0);
    QCOMPARE(int(packet.distance(0, 31)), 0);
    QVERIFY(packet.distance(0, 0) > 0);
}

void TestSimulation::rangesOutOfReachReturnNothing() {
    World world;
    world.edges = {{5, -9, 5, 9}};
    world.poses = {{0, 0, 0}};
    Simulation::Options options;
    options.lidar.sensorHeight = 0.01;
    const auto ahead = [&] {
        Simulation simulation(world, options, start_ns);
        return int(velodyne::DataPacket(simulation.nextPacket().data()).distance(0, velodyne::horizonLaser));
    };
    QVERIFY(std::abs(ahead() - 2500) < 40);
    options.lidar.maxRange = 4.5;
    QCOMPARE(ahead(), 0);
    options.lidar.maxRange = 100;
    options.lidar.minRange = 5.5;
    QCOMPARE(ahead(), 0);
    options.lidar.minRange = 0;
    world.edges = {{-5, 9, -5, -9}}; // behind
    QCOMPARE(ahead(), 0);
}

void TestSimulation::rangesAreQuantised() {
    World world;
    world.edges = {{5.0011, -9, 5.0011, 9}};
    world.poses = {{0, 0, 0}};
    Simulation::Options options;
    options.lidar.sigma = 0;
    options.rpm = 1e-3; // as good as standing still, looking straight ahead
    Simulation simulation(world, options, start_ns);
    for (int block = 0; block < 12; ++block)
        QCOMPARE(int(velodyne::DataPacket(simulation.nextPacket().data()).distance(block, 15)), 2501);
}

void TestSimulation::returnsDropOutAndLieFar() {
    World world;
    world.edges = {{5, -9, 5, 9}};
    world.poses = {{0, 0, 0}};
    Simulation::Options options;
    options.lidar.sigma = 0;
    options.lidar.dropouts = 0.1;
    options.rpm = 1e-3; // as good as standing still, looking straight ahead
    Simulation simulation(world, options, start_ns);
    const auto returns = [&] {
        std::array<int, 3> counts{}; // none, on the wall, elsewhere
        for (int i = 0; i < 500; ++i) {
            const velodyne::DataPacket packet(simulation.nextPacket().data());
            for (int block = 0; block < velodyne::blocksPerPacket; ++block) {
                const int distance = packet.distance(block, velodyne::horizonLaser);
                ++counts[distance == 0 ? 0 : std::abs(distance - 2500) <= 1 ? 1 : 2];
            }
        }
        return counts;
    };
    auto counts = returns();
    QVERIFY(counts[0] > 500 && counts[0] < 700 && counts[2] == 0);
    simulation.lidar().setDropouts(0);
    simulation.lidar().setOutliers(0.05);
    counts = returns();
    QVERIFY(counts[2] > 230 && counts[2] < 370); // 2 mm of 10 m look like the wall
    QVERIFY(counts[0] < 10);                     // nearer than the sensor sees
    simulation.lidar().setOutliers(0);
    counts = returns();
    QCOMPARE(counts[1], 6000);
}

void TestSimulation::sameSeedSamePackets() {
    Simulation::Options options, other;
    other.seed = 2;
    Simulation a(pillars(), options, start_ns), b(pillars(), options, start_ns),
        c(pillars(), other, start_ns);
    for (int i = 0; i < 10; ++i) {
        const auto packet = a.nextPacket();
        QVERIFY(packet == b.nextPacket());
        QVERIFY(packet != c.nextPacket());
    }
}

void TestSimulation::drivesThePathOnce() {
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

void TestSimulation::placing() {
    Simulation simulation(pillars(), {}, start_ns);
    simulation.place({3, 4, 1});
    simulation.nextPacket();
    QCOMPARE(simulation.truth().pose.y, 4.0);
    QVERIFY(!simulation.drive());
    simulation.restart();
    QVERIFY(simulation.drive());
}

void TestSimulation::packetsAreSentAtTheirRate() {
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
    QElapsedTimer timer;
    timer.start();
    QCOMPARE(pump.start(pillars(), {}, "127.0.0.1", receiver.localPort()), std::string());
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

void TestSimulation::pumpRefusesBadAddresses() {
    PacketPump pump([](const Simulation::Truth &) {});
    QCOMPARE(pump.start(pillars(), {}, "nowhere", 2368),
             std::string("nowhere: an IPv4 address such as 127.0.0.1 expected"));
    bool ran = false;
    pump.with([&](Simulation &) { ran = true; });
    QVERIFY(!ran);
}

void TestSimulation::faultsSwallowPackets() {
    QUdpSocket receiver;
    QVERIFY(receiver.bind(QHostAddress(QHostAddress::LocalHost), 0));
    PacketPump pump([](const Simulation::Truth &) {});
    pump.setFault({LidarFault::Kind::Silence, 0});
    QCOMPARE(pump.start(pillars(), {}, "127.0.0.1", receiver.localPort()), std::string());
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

QTEST_GUILESS_MAIN(TestSimulation)
#include "TestSimulation.moc"
