// The search of a scan's place in a whole map.
#include "PlaceCase.h"

#include "tests/support/AllocationCounter.h"

#include <vectorlib/edges/EdgeExtractor.h>
#include <vectorlib/observation/FloorPlan.h>
#include <vectorlib/observation/SimulatedScanner.h>
#include <vectorlib/places/PlaceSearch.h>

using namespace vectorlib;
using Outcome = Relocalized::Outcome;

Q_DECLARE_METATYPE(Points)
Q_DECLARE_METATYPE(Walls)
Q_DECLARE_METATYPE(vectorlib::Relocalized::Outcome)

class TestPlaceSearch : public QObject {
    Q_OBJECT

    // As long as a sanitizer or a busy machine may take.
    static constexpr int muchTooLongMs = 60000;

private Q_SLOTS:
    void init() {
        search = std::make_unique<PlaceSearch>();
        search->maxSeconds = 60; // a bound is tested where it is the matter
        scanner = SimulatedScanner<float>(3);
    }

    void findsPlacesOfFloorPlans_data() { rowsOfSeeds<unsigned>(1, 5); }

    void findsPlacesOfFloorPlans() {
        QFETCH(unsigned, seed);
        FloorPlan plan(seed, 20);
        int found = 0;
        for (int i = 0; i < 20; ++i) {
            const Pose2D pose = plan.place();
            const Relocalized &result = find(plan.walls(), see(plan.walls(), pose));
            QVERIFY(!result.isFound() || isNear(result.places.front().pose, pose));
            found += result.isFound();
        }
        QVERIFY2(found >= 19, saying(found));
    }

    void findsByEdgesAlone() {
        FloorPlan plan(11, 20);
        for (int i = 0; i < 10; ++i) {
            const Pose2D pose = plan.place();
            const Relocalized &result = (*search)(mapOf(plan.walls()), extract(see(plan.walls(), pose)), {});
            QVERIFY2(result.isFound(), result.text().c_str());
            QVERIFY(isNear(result.places.front().pose, pose));
        }
    }

    // A tenth of the rays ends at people who are not in the map.
    void findsAmongOtherThings() {
        FloorPlan plan(12, 20);
        scanner.outliers = 0.1;
        for (int i = 0; i < 10; ++i) {
            const Pose2D pose = plan.place();
            const Relocalized &result = find(plan.walls(), see(plan.walls(), pose));
            QVERIFY2(result.isFound(), result.text().c_str());
            QVERIFY(isNear(result.places.front().pose, pose));
        }
    }

    void tellsIdenticalRooms_data() {
        Rows<int, bool>("rooms",
                        "isChanged"); // isChanged: a cupboard stands there that the map does not know
        for (const int rooms : {2, 4, 5}) {
            QTest::addRow("%d rooms", rooms) << rooms << false;
            QTest::addRow("%d rooms, changed", rooms) << rooms << true;
        }
    }

    void tellsIdenticalRooms() {
        FETCH(int, rooms, bool, isChanged);
        Walls map, world = room(0, 0);
        for (int i = 0; i < rooms; ++i)
            for (const auto &wall : room(7 * i, 0))
                map.push_back(wall);
        if (isChanged)
            putBox(world, 3.9, 1.6, 0.8, 0.6);
        const Relocalized result = find(map, see(world, {2.5, 1.5, 0.7}));
        QCOMPARE(result.outcome, Outcome::Ambiguous);
        QCOMPARE(result.alike, std::size_t(rooms));
        QCOMPARE(result.text(), std::to_string(rooms) + " places in the map fit alike");
        QVERIFY(!isChanged || std::abs(result.places.front().score - 0.96) < 0.01);
        for (int i = 0; i < rooms; ++i)
            QVERIFY(std::any_of(result.places.begin(), result.places.end(), [i](const Place &p) {
                return p.fault == PlaceFault::Alike && isNear(p.pose, {2.5 + 7 * i, 1.5, 0.7});
            }));
        for (const Place &p : result.places)
            QVERIFY(p.probability <= 1.0 / rooms);
    }

    void refusesScansOfOtherBuildings() {
        int found = 0;
        for (unsigned seed = 20; seed < 30; ++seed) {
            const FloorPlan map(seed, 20);
            FloorPlan other(seed + 100, 20);
            for (int i = 0; i < 10; ++i)
                found += find(map.walls(), see(other.walls(), other.place())).isFound();
        }
        QVERIFY2(found <= 1, saying(found)); // one of them is a plain room
    }

    void followsAChangingMap_data() { rowsOfSeeds<unsigned>(31, 34); }

    // Walls come, change and go; the index then says the same as one made anew.
    void followsAChangingMap() {
        QFETCH(unsigned, seed);
        FloorPlan plan(seed, 8);
        std::mt19937 random(seed);
        std::vector<MapEdge> slots = mapOf(plan.walls());
        for (int step = 0; step < 10; ++step) {
            for (MapEdge &edge : slots) {
                const auto dice = random() % 20;
                if (dice == 0)
                    edge.observations = 1 - edge.observations;
                else if (dice == 1) { // grows
                    const auto &s = edge.segment;
                    edge.segment = {s.begin() - s.direction() * 0.02, s.end(), s.direction()};
                }
            }
            if (step == 7)
                slots.resize(slots.size() * 2 / 3);
            const Points points = see(plan.walls(), plan.place());
            const Relocalized changed = (*search)(slots, extract(points), points);
            PlaceSearch anew;
            anew.maxSeconds = search->maxSeconds;
            const Relocalized &made = anew(slots, extract(points), points);
            QCOMPARE(search->index().size(), anew.index().size());
            QCOMPARE(changed.outcome, made.outcome);
            QCOMPARE(changed.places.size(), made.places.size());
            for (std::size_t i = 0; i < made.places.size(); ++i) {
                QCOMPARE(changed.places[i].score, made.places[i].score);
                QVERIFY(isNear(changed.places[i].pose, made.places[i].pose, 1e-12, 1e-12));
            }
        }
        search->index().clear();
        QCOMPARE(search->index().size(), std::size_t(0));
    }

    void covarianceHoldsTheError() {
        FloorPlan plan(41, 10);
        for (int i = 0; i < 10; ++i) {
            const Pose2D pose = plan.place();
            const Relocalized &result = find(plan.walls(), see(plan.walls(), pose));
            QVERIFY(result.isFound() && result.places.front().covariance);
            const Place &place = result.places.front();
            const Eigen::Matrix3d &c = *place.covariance;
            const Eigen::Vector3d error(place.pose.x - pose.x, place.pose.y - pose.y,
                                        wrapAngle(place.pose.theta - pose.theta));
            QVERIFY(error.dot(c.inverse() * error) < 16); // four standard deviations
            QVERIFY(std::sqrt(c(0, 0)) < 0.1 && std::sqrt(c(2, 2)) < 0.05);
        }
    }

    void sameSearchSameResult() {
        FloorPlan plan(51, 20);
        const Points points = see(plan.walls(), plan.place());
        const Pose2D first = find(plan.walls(), points).places.front().pose;
        find(plan.walls(), see(plan.walls(), plan.place()));
        const Pose2D again = find(plan.walls(), points).places.front().pose;
        QVERIFY(isNear(first, again, 1e-12, 1e-12));
    }

    void saysWhatIsWrong_data() {
        constexpr float nan = std::numeric_limits<float>::quiet_NaN();
        Rows<Walls, Points, Outcome>("map", "points", "outcome");
        const Points inRoom = see(room(0, 0), {2.5, 1.5, 0.7});
        const Walls noPlace{{{double(nan), 0}, {1, 0}}, {{0, 0}, {9999, 0}}, {{1, 1}, {1, 1}}};
        QTest::addRow("no map") << Walls() << inRoom << Outcome::NoMap;
        QTest::addRow("a map of nothing usable") << noPlace << inRoom << Outcome::Unfinished;
        QTest::addRow("one wall") << Walls{{{0, 0}, {5, 0}}} << inRoom << Outcome::Nowhere;
        QTest::addRow("no points") << room(0, 0) << Points() << Outcome::TooLittle;
        QTest::addRow("one point") << room(0, 0) << Points(1, {1, 1}) << Outcome::TooLittle;
        QTest::addRow("all in one place") << room(0, 0) << Points(1000, {1, 1}) << Outcome::TooLittle;
        QTest::addRow("no numbers") << room(0, 0) << Points(1000, {nan, nan}) << Outcome::TooLittle;
        QTest::addRow("far away") << room(0, 0) << Points(1000, {1e30f, 1e30f}) << Outcome::TooLittle;
        Points some = inRoom;
        for (std::size_t i = 0; i < some.size(); i += 3)
            some[i] = {nan, nan};
        QTest::addRow("some are no numbers") << room(0, 0) << some << Outcome::Found;
    }

    void saysWhatIsWrong() {
        FETCH(Walls, map, Points, points, Outcome, outcome);
        const Relocalized &result = find(map, points);
        QVERIFY2(result.outcome == outcome, result.text().c_str());
        QVERIFY(!result.text().empty());
        QVERIFY(outcome != Outcome::Found || isNear(result.places.front().pose, {2.5, 1.5, 0.7}));
    }

    // A scan with too little in it does not wait for the index of a map.
    void looksAtTheScanFirst() {
        QCOMPARE(find(room(0, 0), Points(1000, {1, 1})).outcome, Outcome::TooLittle);
        QCOMPARE(search->index().size(), std::size_t(0));
        std::vector<MapEdge> slots = mapOf(room(0, 0)); // of edges that are no more
        for (MapEdge &edge : slots)
            edge.observations = 0;
        const Points points = see(room(0, 0), {2.5, 1.5, 0.7});
        QCOMPARE((*search)(slots, extract(points), points).outcome, Outcome::NoMap);
    }

    void endsInTime() {
        // 100,000 points.
        scanner.rays = 100000;
        const Points many = see(room(0, 0), {2.5, 1.5, 0.7});
        auto time = runningTimer();
        QVERIFY(find(room(0, 0), many).isFound());
        QVERIFY2(time.elapsed() < muchTooLongMs * slowness, saying(time.elapsed()));
        // 500,000 walls, of which the index is not made in the time that is given.
        std::mt19937 random(6);
        Walls map;
        for (int i = 0; i < 500000; ++i) {
            const Vector2D<double> at(double(random() % 200000) / 100, double(random() % 200000) / 100);
            map.emplace_back(at,
                             at + Vector2D<double>(0.5 + double(random() % 100) / 50, double(random() % 3)));
        }
        scanner.rays = 720;
        const Points points = see(room(0, 0), {2.5, 1.5, 0.7});
        const auto slots = mapOf(map);
        search->maxSeconds = 0.02;
        const Relocalized &result = (*search)(slots, extract(points), points);
        QCOMPARE(result.outcome, Outcome::Unfinished);
        QVERIFY2(result.ms < muchTooLongMs, saying(result.ms));
        const std::size_t before = search->index().size();
        QVERIFY(before > 0 && before < slots.size());
        (*search)(slots, extract(points), points); // goes on from there
        QVERIFY(search->index().size() > before);
    }

    void boundsLongAndFarWalls() {
        Walls map = room(0, 0);
        for (int i = 0; i < 100; ++i) // 150 km in all: more than there is room for
            map.emplace_back(Vector2D<double>(10, 10 + i), Vector2D<double>(1510, 10 + i));
        map.emplace_back(Vector2D<double>(1e9, 0), Vector2D<double>(1e9, 5));
        search->index().tiles().maxEntries = 100000;
        const Relocalized &result = find(map, see(room(0, 0), {2.5, 1.5, 0.7}));
        QCOMPARE(result.outcome, Outcome::Unfinished); // as not all walls were searched
        QVERIFY(search->index().leftOut() > 0);
        QVERIFY(QString::fromStdString(result.text()).endsWith(" parts of the search were done"));
        QVERIFY(isNear(result.places.front().pose, {2.5, 1.5, 0.7}));
    }

    void takesRefusedWallsWhenThereIsRoom() {
        PlaceIndex index;
        index.tiles().maxEntries = 700; // one of the walls needs some 500
        std::vector<MapEdge> slots = mapOf({{{0, 0}, {200, 0}}, {{0, 10}, {200, 10}}});
        index.follow(slots);
        QCOMPARE(index.leftOut(), std::size_t(1));
        slots[0].observations = 0;
        index.follow(slots);
        QCOMPARE(index.size(), std::size_t(1));
        QCOMPARE(index.leftOut(), std::size_t(0));
    }

    // A map that was loaded after another costs what it would alone.
    void aSmallerMapIsAnotherMap() {
        Walls town;
        for (int i = 0; i < 100; ++i)
            for (int j = 0; j < 100; ++j)
                for (const auto &wall : room(7 * i, 6 * j))
                    town.push_back(wall);
        const Points points = see(room(0, 0), {2.5, 1.5, 0.7});
        const double first = find(town, points).ms;
        search->maxSeconds = 1;
        const Relocalized &result = find(room(0, 0), points);
        QVERIFY2(result.isFound(), result.text().c_str());
        QVERIFY2(result.ms < first, saying("%1 ms after %2 ms", result.ms, first));
        PlaceIndex anew;
        anew.follow(mapOf(room(0, 0)));
        QCOMPARE(search->index().size(), anew.size());
        QCOMPARE(search->index().tiles().tiles(), anew.tiles().tiles());
    }

    void acceptsPlacesAsTheOutcomeSays_data() {
        Rows<Walls, bool>("map", "differs"); // differs: one wall of the map, from what is there
        Walls rooms = room(0, 0);
        for (const auto &wall : room(7, 0))
            rooms.push_back(wall);
        QTest::addRow("a room") << room(0, 0) << false;
        QTest::addRow("a room that differs") << room(0, 0) << true;
        QTest::addRow("two rooms") << rooms << false;
        QTest::addRow("two rooms of which one differs") << rooms << true;
    }

    // However much evidence is asked for: from any place that fits a little to none at all.
    void acceptsPlacesAsTheOutcomeSays() {
        FETCH(Walls, map, bool, differs);
        if (differs)
            map[2] = {map[2].begin(), map[2].begin() + map[2].direction() * 2.5};
        const Points points = see(room(0, 0), {2.5, 1.5, 0.7});
        std::set<Outcome> outcomes;
        for (double constant = -50; constant < 0; constant += 0.25) {
            search->trust.constant = constant;
            const Relocalized &result = find(map, points);
            const auto accepted =
                std::size_t(std::count_if(result.places.begin(), result.places.end(),
                                          [](const Place &p) { return p.fault == PlaceFault::None; }));
            const bool isFirst = !result.places.empty() && result.places.front().fault == PlaceFault::None;
            QVERIFY2(isFirst == (accepted > 0), saying(constant));
            QVERIFY2(accepted == (result.outcome == Outcome::Found), saying(constant));
            outcomes.insert(result.outcome);
        }
        QVERIFY(outcomes.count(Outcome::Nowhere));
        QVERIFY(outcomes.size() > 1);
    }

    void allocatesNothingInSteadyState() {
        FloorPlan plan(61, 20);
        const auto slots = mapOf(plan.walls());
        const Points first = see(plan.walls(), plan.place()), second = see(plan.walls(), plan.place());
        const std::vector<EdgeRaw2D> edges = extract(first), others = extract(second);
        const std::size_t more = allocationsOnceGrown(3, [&] {
            (*search)(slots, edges, first);
            (*search)(slots, others, second);
        });
        QCOMPARE(more, std::size_t(0));
    }

private:
    const Points &see(const Walls &walls, const Pose2D &pose) {
        world_.clear();
        for (const auto &wall : walls)
            world_.emplace_back(wall);
        return scanner(world_, pose);
    }
    const Relocalized &find(const Walls &map, const Points &points) {
        return search->operator()(mapOf(map), extract(points), points);
    }

    SimulatedScanner<float> scanner{3};
    EdgeExtractor extract;
    std::unique_ptr<PlaceSearch> search;
    std::vector<LineSegment2D<float>> world_;
};
