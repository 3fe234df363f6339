// The demo's drive, packet by packet, gives the same map on every machine: the one that is stored, within a
// millimetre.
#include "Pillars.h"
#include "daemons/simulator/Simulation.h"
#include "protocol/velodyne/TurnAssembler.h"
#include "vectorlib/io/MapCsv.h"
#include "vectorlib/mapping/ScanTracker.h"

using namespace hermes;
using namespace hermes::simulator;
using namespace vectorlib;

static constexpr std::int64_t start_ns = 1700000000000000000;
static constexpr double most = 0.001; // metres

static TimedScan scanOf(const velodyne::Turn &turn) {
    TimedScan scan;
    scan.stamp = double(turn.begin_ns) * 1e-9;
    scan.rays = turn.firings;
    for (auto p = turn.points.rbegin(); p != turn.points.rend(); ++p) { // counter-clockwise
        scan.points.emplace_back(float(p->x), float(p->y));
        scan.seconds.push_back(float(double(p->stamp_ns - turn.begin_ns) * 1e-9));
    }
    return scan;
}

class TestDrivenMap : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void isTheStoredOne() {
        Simulation simulation(pillars(), {}, start_ns);
        QVERIFY(simulation.drive());
        ScanTracker tracker;
        tracker.place(simulation.truth().pose);
        int turns = 0;
        velodyne::TurnAssembler assembler({}, [&](const velodyne::Turn &turn) {
            TimedScan scan = scanOf(turn);
            if (!turn.partial && ++turns)
                tracker.process(scan);
        });
        while (!simulation.truth().finished)
            assembler.feed(simulation.nextPacket().data(), velodyne::packetSize, simulation.now_ns());
        const Pose2D at = tracker.builder.report().pose, truth = simulation.truth().pose;
        const double off = std::hypot(at.x - truth.x, at.y - truth.y);
        QVERIFY(turns > 200);
        QVERIFY2(off < 0.15, saying(off)); // of the last turn's middle

        const std::string name =
            qEnvironmentVariable("HERMES_SOURCE").toStdString() + "/tests/data/driven-map.csv";
        std::ifstream file(name);
        const auto stored = readMapCsv(file, name);
        std::ofstream made("driven-map.csv"); // for a look at it, and to be stored where the change is meant
        std::vector<MapEdge> map;
        for (const MapEdge &edge : tracker.builder.map.slots())
            if (edge.observations > 0)
                map.push_back(edge);
        writeMapCsv(made, map);
        QVERIFY2(stored, stored ? "" : stored.error().message().c_str());
        QCOMPARE(map.size(), stored->size());
        double worst = 0;
        for (std::size_t i = 0; i < map.size(); ++i) {
            QCOMPARE(map[i].id, (*stored)[i].id);
            const auto &a = map[i].segment, &b = (*stored)[i].segment;
            worst = std::max({worst, (a.begin() - b.begin()).norm(), (a.end() - b.end()).norm()});
        }
        qInfo("%d turns, %zu walls, %.1f um from the stored ones, the pose %.1f mm off", turns, map.size(),
              worst * 1e6, off * 1e3);
        QVERIFY2(worst < most, saying("%1 m", worst));
    }
};
