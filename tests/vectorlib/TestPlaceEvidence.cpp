// What one object says is no evidence of a place.
#include "PlaceCase.h"

#include <vectorlib/edges/EdgeExtractor.h>
#include <vectorlib/observation/FloorPlan.h>
#include <vectorlib/observation/SimulatedScanner.h>
#include <vectorlib/places/PlaceSearch.h>

using namespace vectorlib;

Q_DECLARE_METATYPE(FloorPlan::Rooms)

class TestPlaceEvidence : public QObject {
    Q_OBJECT

    struct Box {
        double x, y, width, depth;
    };

    // On the left side of the room, or on its right one.
    static Box drawnBox(std::mt19937 &random, bool isRight) {
        const auto between = [&random](double a, double b) {
            return a + (b - a) * double(random() % 10001) / 1e4;
        };
        return {between(0.2, 0.8) + (isRight ? 2.8 : 0), between(0.1, 2.0), between(0.4, 1.2),
                between(0.3, 0.8)};
    }

private Q_SLOTS:
    // Points of one object, whether it was seen from its short side first or last.
    void numbersObjects() {
        const std::vector<LineSegment2D<double>> walls{{{2, 0}, {2, 1}}, {{5, 3}, {1, 3}}};
        std::vector<WallPoint> points;
        for (const Vector2D<float> p : {Vector2D<float>(2.2f, -0.1f), Vector2D<float>(2.1f, 0)}) // the side
            points.push_back({p, {1, 0}});
        for (const float y : {0.1f, 0.5f, 0.9f})
            points.push_back({{2, y}, {0, 1}});
        points.push_back({{2.2f, 1.1f}, {1, 0}}); // the other side
        points.push_back({{3, 3}, {-1, 0}});
        points.push_back({{0, 1}, {0, -1}}); // something else
        ScanObjects objects;
        objects.number(walls, points);
        for (std::size_t i = 0; i < 6; ++i)
            QCOMPARE(points[i].object, points[2].object);
        QVERIFY(points[6].object != points[2].object);
        QVERIFY(points[7].object != points[2].object && points[7].object != points[6].object);
    }

    // Two rooms that a cupboard tells apart, and then a second one.
    void oneObjectIsNoEvidence() {
        search_.maxSeconds = 60;
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

    void objectsThatAreMoved_data() {
        const Rows<int, bool, int, int> row(
            "each", "isMoved", "least",
            "maxWrong"); // each: objects that tell two rooms apart; isMoved: one of them, to where that of
                         // the other room stands; least: found of 100
        row("two each", 2, false, 88, 0);
        row("one each, moved", 1, true, 0, 1);
        row("two each, one moved", 2, true, 0, 0);
    }

    // Several objects tell where the robot is; one that was moved does not lead it into the other room.
    void objectsThatAreMoved() {
        FETCH(int, each, bool, isMoved, int, least, int, maxWrong);
        search_.maxSeconds = 60;
        int found = 0, wrong = 0;
        std::mt19937 random(77);
        for (int i = 0; i < 100; ++i) {
            Walls world = room(0, 0), map = room(0, 0);
            for (const auto &wall : room(7, 0))
                map.push_back(wall);
            for (int k = 0; k < each; ++k) {
                const Box own = drawnBox(random, k > 0), other = drawnBox(random, k > 0);
                const Box now = isMoved && k == 0 ? other : own;
                putBox(map, own.x, own.y, own.width, own.depth);
                putBox(map, 7 + other.x, other.y, other.width, other.depth);
                putBox(world, now.x, now.y, now.width, now.depth);
            }
            const Pose2D pose = FloorPlan::placeAmong(world, random);
            const Relocalized &result = find(mapOf(map), world, pose);
            const bool isRight = result.isFound() && isNear(result.places.front().pose, pose);
            found += isRight;
            wrong += result.isFound() && !isRight;
        }
        qInfo("seed 77: of 100 found %d, wrong %d", found, wrong);
        QVERIFY(found >= least);
        QVERIFY(wrong <= maxWrong);
    }

    void movedFurniture_data() {
        const Rows<FloorPlan::Rooms, double, int> row("kind", "share", "least"); // least: found of 100
        row("a tenth", FloorPlan::Rooms::Different, 0.1, 90);
        row("a third", FloorPlan::Rooms::Different, 0.3, 85);
        row("most", FloorPlan::Rooms::Different, 0.6, 65);
        row("none, rooms alike", FloorPlan::Rooms::Alike, 0.0, 74);
        row("a third, rooms alike", FloorPlan::Rooms::Alike, 0.3, 35);
    }

    // Between the map and the scan; also of another building, which has no place in the map.
    void movedFurniture() {
        FETCH(FloorPlan::Rooms, kind, double, share, int, least);
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
