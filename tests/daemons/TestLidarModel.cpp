// The packets of the simulated lidar, decoded again: points lie where the walls are.
#include "Pillars.h"
#include "daemons/simulator/Simulation.h"
#include "protocol/velodyne/Hdl32e.h"
#include "protocol/velodyne/TurnAssembler.h"
#include "vectorlib/geometry/Transformation2D.h"

using namespace hermes;
using namespace hermes::simulator;
using vectorlib::Transformation2D;
using Point = vectorlib::Vector2D<double>;

static constexpr std::int64_t start_ns = 1700000000000000000;

/// The robot looks at it from the origin.
static World wallAhead(double x) {
    World world;
    world.edges = {{x, -9, x, 9}};
    world.poses = {{0, 0, 0}};
    return world;
}

static Simulation::Options exactAndStill() {
    Simulation::Options options;
    options.lidar.sigma = 0;
    options.rpm = 1e-3; // as good as standing still, looking straight ahead
    return options;
}

class TestLidarModel : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void ringPointsLieOnTheWalls_data() {
        const Rows<bool, double> row("driving", "sigma");
        row("standing, no noise", false, 0.0);
        row("standing", false, 0.01);
        row("driving, no noise", true, 0.0);
        row("driving", true, 0.01);
    }

    void ringPointsLieOnTheWalls() {
        FETCH(bool, driving, double, sigma);
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
                for (; truthTime_ns + velodyne::hdl32e.firingPeriod_ns < point.stamp_ns;
                     truthTime_ns += velodyne::hdl32e.firingPeriod_ns)
                    truth.advance(velodyne::hdl32e.firingPeriod_ns * 1e-9);
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
        QVERIFY2(far <= points * 2e-4, saying(far));
        QVERIFY(std::sqrt(squares / double(points)) < sigma + 0.001);
        QVERIFY(sigma == 0 || std::sqrt(squares / double(points)) > sigma / 3);
        QVERIFY(std::abs(assembler.rpm() - 600) < 0.5);
    }

    void lasersMeetWallsFloorOrNothing() {
        World world = pillars();
        world.edges.resize(4);
        world.poses = {{4, 3, 0}};
        Simulation::Options options;
        options.lidar.sigma = 0;
        Simulation simulation(world, options, start_ns);
        int walls = 0, floors = 0;
        std::array<int, velodyne::hdl32e.lasers> ofLaser{};
        velodyne::TurnAssembler::Options all;
        all.laser = velodyne::PacketDecoder::allLasers;
        velodyne::TurnAssembler assembler(all, [&](const velodyne::Turn &turn) {
            for (const velodyne::Point &p : turn.points) {
                // Half a count of 2 mm along the steepest beam, hence the lasers' own heights are in it.
                const bool floor = std::abs(p.z + options.lidar.sensorHeight) < 0.00053;
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
        QCOMPARE(int(packet.distance(0, velodyne::hdl32e.horizonLaser)), 0);
        QCOMPARE(int(packet.distance(0, 31)), 0);
        QVERIFY(packet.distance(0, 0) > 0);
    }

    void rangesOutOfReachReturnNothing() {
        World world = wallAhead(5);
        Simulation::Options options;
        options.lidar.sensorHeight = 0.01;
        const auto ahead = [&] {
            Simulation simulation(world, options, start_ns);
            return int(velodyne::DataPacket(simulation.nextPacket().data())
                           .distance(0, velodyne::hdl32e.horizonLaser));
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

    void rangesAreQuantised() {
        World world = wallAhead(5.0011);
        Simulation::Options options = exactAndStill();
        Simulation simulation(world, options, start_ns);
        for (int block = 0; block < 12; ++block)
            QCOMPARE(int(velodyne::DataPacket(simulation.nextPacket().data()).distance(block, 15)), 2501);
    }

    void returnsDropOutAndLieFar() {
        World world = wallAhead(5);
        Simulation::Options options = exactAndStill();
        options.lidar.dropouts = 0.1;
        Simulation simulation(world, options, start_ns);
        const auto returns = [&] {
            std::array<int, 3> counts{}; // none, on the wall, elsewhere
            for (int i = 0; i < 500; ++i) {
                const velodyne::DataPacket packet(simulation.nextPacket().data());
                for (int block = 0; block < velodyne::blocksPerPacket; ++block) {
                    const int distance = packet.distance(block, velodyne::hdl32e.horizonLaser);
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

    void sameSeedSamePackets() {
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

    void peopleStandBeforeTheWall() {
        World world = wallAhead(5);
        world.people = {{1e-6, {{2, 0}, {2, 1}}}};
        Simulation::Options options = exactAndStill();
        const auto distance = [&](int laser) {
            Simulation simulation(world, options, start_ns);
            return double(velodyne::DataPacket(simulation.nextPacket().data()).distance(0, laser)) * 0.002;
        };
        const int horizon = velodyne::hdl32e.horizonLaser;
        QVERIFY(std::abs(distance(horizon) - (2 - People::radius)) < 0.002);
        options.lidar.sensorHeight = People::height + 0.1; // over the head
        QVERIFY(std::abs(distance(horizon) - 5) < 0.002);
        options.lidar.sensorHeight = 0.5;
        world.people[0].way = {{2, People::radius + 0.01}, {2, 1}}; // beside
        QVERIFY(std::abs(distance(horizon) - 5) < 0.002);
        world.people[0].way = {{-2, 0}, {-2, 1}}; // behind
        QVERIFY(std::abs(distance(horizon) - 5) < 0.002);
        world.people[0].way = {{7, 0}, {7, 1}}; // hidden
        QVERIFY(std::abs(distance(horizon) - 5) < 0.002);
    }

    void levelRaysMeetWallsAndPeople() {
        LidarModel::Options options;
        options.sigma = 0;
        World world;
        world.people = {{1e-6, {{2, 2}, {2, 3}}}};
        const People people(world.people, 0.3);
        LidarModel lidar({{{5, -9}, {5, 9}}, {{-9, 4}, {9, 4}}}, options, 1);
        const double away = std::atan2(1.0, 2.0), person = std::hypot(1.0, 2.0) - People::radius;
        for (const double theta : {0.0, 2.5, -1.0}) {
            lidar.stand({0, 1, theta}, people);
            QVERIFY(std::abs(lidar.range(0 - theta) - 5) < 1e-9);
            QVERIFY(std::abs(lidar.range(0.04 - theta) - 5 / std::cos(0.04)) < 1e-9); // beside the first
            QVERIFY(std::abs(lidar.range(M_PI / 2 - theta) - 3) < 1e-9);
            QCOMPARE(lidar.range(-M_PI / 2 - theta), 0.0);
            QVERIFY(std::abs(lidar.range(away - theta) - person) < 1e-9);
        }
        lidar.stand({1, 1, 0}, people); // it looks anew
        QVERIFY(std::abs(lidar.range(0) - 4) < 1e-9);
        options.sensorHeight = People::height + 0.1; // over the head
        lidar = LidarModel({{{5, -9}, {5, 9}}}, options, 1);
        lidar.stand({0, 1, 0}, people);
        QVERIFY(std::abs(lidar.range(away) - 5 / std::cos(away)) < 1e-9);
    }

    void peopleAreWhereTheyAreAtEachFiring() {
        World world = wallAhead(9);
        world.people = {{2, {{4, 0}, {8, 0}}}};
        Simulation::Options options = exactAndStill();
        Simulation simulation(world, options, start_ns);
        int firings = 0;
        for (int i = 0; i < 1808; ++i) {
            const velodyne::DataPacket packet(simulation.nextPacket().data());
            for (int block = 0; block < velodyne::blocksPerPacket; ++block) {
                const double seconds = firings++ * velodyne::hdl32e.firingPeriod_ns * 1e-9;
                const double distance = packet.distance(block, velodyne::hdl32e.horizonLaser) * 0.002;
                QVERIFY(std::abs(distance - (4 + 2 * seconds - People::radius)) < 0.0015);
            }
        }
    }
};
