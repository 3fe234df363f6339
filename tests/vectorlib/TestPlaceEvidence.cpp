// What one object says is no evidence of a place.
#include "PlaceCase.h"

#include <vectorlib/edges/EdgeExtractor.h>
#include <vectorlib/observation/FloorPlan.h>
#include <vectorlib/observation/SimulatedScanner.h>
#include <vectorlib/places/PlaceSearch.h>

#include <QtTest>

using namespace vectorlib;

class TestPlaceEvidence : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void oneObjectIsNoEvidence();
    void movedFurniture_data();
    void movedFurniture();

private:
    const Relocalized &find(const std::vector<MapEdge> &map, const Walls &world, const Pose2D &pose) {
        world_.clear();
        for (const auto &wall : world)
            world_.emplace_back(wall);
        const Points &points = scanner_(world_, pose);
        return search_(map, extract_(points), points);
    }

    SimulatedScanner<float> scanner_{3};
    EdgeExtractor extract_;
    PlaceSearch search_;
    std::vector<LineSegment2D<float>> world_;
};

// Two rooms that a cupboard tells apart, and then a second one.
void TestPlaceEvidence::oneObjectIsNoEvidence() {
    search_.maxSeconds = 60;
    const auto putBox = [](Walls &walls, double x, double y) {
        const Vector2D<double> a(x, y), b(x, y + 0.6), c(x + 0.9, y + 0.6), d(x + 0.9, y);
        for (const auto &side : {LineSegment2D<double>(a, b), {b, c}, {c, d}, {d, a}})
            walls.push_back(side);
    };
    Walls world = room(0, 0), map = room(7, 0);
    putBox(world, 3.8, 0.4);
    map.insert(map.begin(), world.begin(), world.end());
    const Pose2D pose{2.5, 1.5, 0.7};
    QVERIFY(!find(mapOf(map), world, pose).isFound());
    putBox(world, 0.3, 2);
    putBox(map, 0.3, 2);
    const Relocalized &result = find(mapOf(map), world, pose);
    QVERIFY2(result.isFound(), result.text().c_str());
    QVERIFY(isNear(result.places.front().pose, pose));
}

void TestPlaceEvidence::movedFurniture_data() {
    QTest::addColumn<FloorPlan::Rooms>("kind");
    QTest::addColumn<double>("share");
    QTest::addColumn<int>("least"); // found of 100
    QTest::newRow("a tenth") << FloorPlan::Rooms::Different << 0.1 << 90;
    QTest::newRow("a third") << FloorPlan::Rooms::Different << 0.3 << 85;
    QTest::newRow("most") << FloorPlan::Rooms::Different << 0.6 << 65;
    QTest::newRow("a third, rooms alike") << FloorPlan::Rooms::Alike << 0.3 << 35;
}

Q_DECLARE_METATYPE(FloorPlan::Rooms)

// Between the map and the scan; also of another building, which has no place in the map.
void TestPlaceEvidence::movedFurniture() {
    QFETCH(FloorPlan::Rooms, kind);
    QFETCH(double, share);
    QFETCH(int, least);
    search_.maxSeconds = 60;
    int found = 0, wrong = 0, foreign = 0;
    for (unsigned seed = 9001; seed <= 9005; ++seed) {
        const FloorPlan plan(seed, 20, kind);
        const auto map = mapOf(plan.walls());
        FloorPlan later = plan.refurnished(seed, share), other(seed + 100, 20, kind);
        for (int i = 0; i < 20; ++i) {
            const Pose2D pose = later.place();
            const Relocalized &result = find(map, later.walls(), pose);
            const bool isRight = result.isFound() && isNear(result.places.front().pose, pose, 0.5, 0.17);
            found += isRight;
            wrong += result.isFound() && !isRight;
            foreign += find(map, other.walls(), other.place()).isFound();
        }
    }
    qInfo("seeds 9001 to 9005: of 100 found %d, wrong %d, of another building %d", found, wrong, foreign);
    QVERIFY(found >= least);
    QCOMPARE(wrong, 0);
    QCOMPARE(foreign, 0);
}

QTEST_APPLESS_MAIN(TestPlaceEvidence)
#include "TestPlaceEvidence.moc"
