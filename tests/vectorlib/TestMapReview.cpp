#include <vectorlib/mapping/MapBuilder.h>
#include <vectorlib/mapping/MapReview.h>
#include <vectorlib/mapping/WallEvidence.h>

#include "tests/vectorlib/ScanWorld.h"

using namespace vectorlib;

/// What becomes of a map when all scans of its drive are asked again.
class TestMapReview : public QObject {
    Q_OBJECT

    using Point = Vector2D<double>;
    using Wall = LineSegment2D<double>;

    static EdgeRaw2D edgeOf(const Wall &wall) {
        std::vector<Point> points;
        for (int i = 0; i <= 20; ++i)
            points.push_back(wall.begin() + (wall.end() - wall.begin()) * (i / 20.0));
        return {TlsSums::of(points.begin(), points.end()), wall, 0};
    }
    /// Scans and their poses.
    struct Drive {
        std::vector<std::vector<EdgeRaw2D>> edges;
        std::vector<Pose2D> poses;

        /// A scan at a place that sees these walls, of the map's frame.
        void see(const std::vector<Wall> &walls, Pose2D pose) {
            edges.emplace_back();
            for (const Wall &wall : walls)
                edges.back().push_back(edgeOf(Transformation2D(pose).inverse() * wall));
            poses.push_back(pose);
        }
        /// Many scans along a line of y = 0, 20 cm apart.
        void pass(const std::vector<Wall> &walls, int scans) {
            for (int i = 0; i < scans; ++i)
                see(walls, {0.2 * i, 0, 0});
        }
        ScanDrive all() const { return {edges, poses}; }
    };
    /// A corridor from x = -3 to 7, the upper wall as asked for.
    static std::vector<Wall> corridor(std::vector<Wall> upper) {
        upper.push_back({{-3, -2}, {7, -2}});
        return upper;
    }
    static inline const Wall upperWall{{7, 2}, {-3, 2}};

    static VectorMap mapOf(const std::vector<Wall> &walls, std::int64_t observations = 10) {
        VectorMap map;
        for (const Wall &wall : walls)
            map.add(edgeOf(wall), observations);
        return map;
    }
    static double lengthOf(const VectorMap &map) {
        double sum = 0;
        map.forEach([&](const MapEdge &e) { sum += e.segment.length(); });
        return sum;
    }
    /// Whether the map has a wall within 8 cm of a place, whatever its direction.
    static bool hasWallAt(const VectorMap &map, Point place) {
        bool found = false;
        map.forEach([&](const MapEdge &e) { found = found || e.segment.distance(place) < 0.08; });
        return found;
    }
    static void addBox(ScanWorld &world, Point low, Point high) {
        const ScanWorld box = ScanWorld::of({low, {high.x, low.y}, high, {low.x, high.y}});
        world.walls.insert(world.walls.end(), box.walls.begin(), box.walls.end());
    }

private Q_SLOTS:
    // The drive goes round a room twice; between, a box is moved. People walk all the time.
    void movedBoxesAndPeopleLeave() {
        constexpr unsigned seed = 3;
        std::mt19937 random(seed);
        const std::vector<Point> corners = {{-4, -3}, {4, -3}, {4, 3}, {-4, 3}};
        ScanWorld before = ScanWorld::of(corners), after = before;
        addBox(before, {1, 0.5}, {2, 1.3});
        addBox(after, {-2.2, 0.5}, {-1.2, 1.3});
        MapBuilder builder;
        builder.extract.segment.settings = EarSettings::forScanner(2 * pi, 720);
        Drive drive;
        constexpr int scans = 160;
        for (int i = 0; i < scans; ++i) {
            ScanWorld world = i < scans / 2 ? before : after;
            const double way = 4 * pi * i / scans;
            const auto anywhere = [&](double reach) { return reach * (double(random() % 2001) / 1000 - 1); };
            for (int person = 0; person < 2; ++person) {
                const double x = anywhere(3);
                addBox(world, {x - 0.25, -1.9}, {x + 0.25, -1.6});
            }
            const Pose2D pose{3 * std::cos(way), 2.4 * std::sin(way), way};
            const auto points =
                world.scan(Transformation2D(pose), random, {720, 2 * pi * 719 / 720, 0.01, 30});
            drive.edges.push_back(builder.extract(points));
            drive.poses.push_back(pose);
            builder.place(drive.edges.back(), pose);
        }
        VectorMap map = builder.map;
        QVERIFY(hasWallAt(map, {1.5, 1.3}) && hasWallAt(map, {2, 0.9}));
        const MapReviewCounts counts = MapReview()(map, drive.all());
        QVERIFY(counts.removed > 0);
        for (const Point gone : {Point(1.5, 1.3), Point(1.5, 0.5), Point(2, 0.9), Point(1, 0.9)})
            QVERIFY2(!hasWallAt(map, gone), saying("%1, %2", gone.x, gone.y));
        for (const Point stays : {Point(-1.7, 1.3), Point(-1.7, 0.5), Point(-1.2, 0.9), Point(-2.2, 0.9)})
            QVERIFY2(hasWallAt(map, stays), saying("%1, %2", stays.x, stays.y));
        for (std::size_t i = 0; i < corners.size(); ++i)
            for (double t = 0.02; t < 1; t += 0.02) {
                const Point p = corners[i] + (corners[(i + 1) % 4] - corners[i]) * t;
                QVERIFY2(hasWallAt(map, p), saying("%1, %2", p.x, p.y));
            }
        const auto people = [](const VectorMap &of) {
            double sum = 0;
            of.forEach([&](const MapEdge &e) {
                const Point p = e.segment.middle();
                sum += std::abs(p.x) < 3.3 && p.y < -1.4 && p.y > -2.1 ? e.segment.length() : 0;
            });
            return sum;
        };
        qInfo("people: %.1f m to %.1f m", people(builder.map), people(map));
        QVERIFY2(people(map) < 0.25 * people(builder.map), saying(people(map)));
        // What stays, stays under its number.
        map.forEach([&](const MapEdge &e) {
            if (std::size_t(e.id) < builder.map.slots().size())
                QVERIFY(builder.map.slots()[std::size_t(e.id)].segment.distance(e.segment.middle()) < 0.2);
        });
    }

    // Scans look through the place of a wall; or a second scanner does, from a place of its own.
    void onlyOwnSightContradicts_data() { falseAndTrue("isOwn", "of the second scanner", "its own"); }
    void onlyOwnSightContradicts() {
        QFETCH(bool, isOwn);
        const Wall pillar({3, 1}, {2, 1});
        VectorMap map = mapOf(corridor({upperWall, pillar}));
        Drive drive;
        drive.pass(corridor({upperWall, pillar}), 4);
        drive.pass({{{-3, -2}, {7, -2}}, upperWall}, 30);
        std::vector<std::uint32_t> own(drive.edges.size(), isOwn ? 2 : 1);
        std::fill_n(own.begin(), 4, 3);
        MapReview()(map, {drive.edges, drive.poses, &own});
        QCOMPARE(hasWallAt(map, {2.5, 1}), !isOwn);
    }
    // Each scan sees one of them: the same wall from two poses that do not agree.
    void wallsThatAreThereTwiceBecomeOne() {
        const Wall twin({5, 2.09}, {1, 2.09});
        VectorMap map = mapOf(corridor({upperWall, twin}));
        Drive drive;
        drive.pass(corridor({upperWall}), 10);
        drive.pass(corridor({twin}), 10);
        ParallelTwins twins;
        const TwinShare before = twins.share(map, drive.all());
        QVERIFY(std::abs(before.twins - 8) < 1e-9 && std::abs(before.walls - 24) < 1e-9);
        QCOMPARE(before.real, 0.0);
        const MapReviewCounts counts = MapReview()(map, drive.all());
        QCOMPARE(counts.merged, std::size_t(1));
        QCOMPARE(twins.share(map, drive.all()).twins, 0.0);
        QCOMPARE(map.size(), std::size_t(2));
        const MapEdge &wall = map.slots()[0];
        QCOMPARE(wall.observations, 20);
        QCOMPARE(wall.sums.n, 42.0);
        QVERIFY(wall.segment.length() > 9.9 && std::abs(wall.segment.middle().y - 2.03) < 0.03);
    }
    // Scans see both at once: a cupboard before its wall.
    void whatScansSeeAtOnceIsReal() {
        const Wall cupboard({3, 1.9}, {2, 1.9});
        const std::vector<Wall> walls = corridor({{{7, 2}, {3, 2}}, {{2, 2}, {-3, 2}}, cupboard});
        VectorMap map = mapOf(corridor({upperWall, cupboard}));
        Drive drive;
        drive.pass(walls, 1);
        ParallelTwins twins;
        QVERIFY(twins.share(map, drive.all()).twins > 1.9); // one scan alone may err
        drive.pass(walls, 10);
        const TwinShare share = twins.share(map, drive.all());
        QCOMPARE(share.twins, 0.0);
        QVERIFY(std::abs(share.real - 2) < 1e-9);
        QCOMPARE(MapReview()(map, drive.all()).merged, std::size_t(0));
        QCOMPARE(map.size(), std::size_t(3));
    }
    // Farther apart, facing each other, at an angle, or side by side for a short way only.
    void whatIsNoTwin() {
        Drive drive;
        drive.pass(corridor({upperWall}), 3);
        for (const Wall &other : {Wall({5, 2.7}, {1, 2.7}), Wall({1, 2.2}, {5, 2.2}),
                                  Wall({5, 2.1}, {1, 3.1}), Wall({-2, 2.1}, {-5, 2.1})}) {
            const TwinShare share = ParallelTwins().share(mapOf({upperWall, other}), drive.all());
            QVERIFY(share.twins == 0 && share.real == 0 && share.walls > 12);
        }
        const TwinShare seldom =
            ParallelTwins().share(mapOf({upperWall, {{5, 2.1}, {1, 2.1}}}, 2), drive.all());
        QVERIFY(seldom.walls == 0 && seldom.share() == 0);
    }

    // An open door: what scans saw of the wall beside it stays, in two pieces.
    void aDoorThatOpensLeavesItsWall() {
        VectorMap map = mapOf(corridor({upperWall}));
        Drive drive;
        drive.pass(corridor({upperWall}), 20);
        drive.pass(corridor({{{7, 2}, {3, 2}}, {{4, 4}, {1, 4}}, {{2, 2}, {-3, 2}}}), 20);
        const MapReviewCounts counts = MapReview()(map, drive.all());
        QCOMPARE(counts.cut, std::size_t(1));
        QCOMPARE(counts.removed, std::size_t(0));
        QCOMPARE(map.size(), std::size_t(3));
        QVERIFY2(std::abs(counts.contradicted - 1) < 0.41, saying(counts.contradicted));
        QVERIFY(!hasWallAt(map, {2.5, 2}) && hasWallAt(map, {3.3, 2}) && hasWallAt(map, {1.7, 2}));
        double points = 0;
        map.forEach([&](const MapEdge &e) {
            points += e.sums.n;
            const TlsLine line = fitLine(e.sums);
            QVERIFY(std::abs(line.line.signedDistance(e.segment.begin())) < 1e-9);
        });
        QVERIFY(std::abs(points - 42 + 21 * counts.contradicted / 10) < 1e-6);
        QVERIFY(map.slots()[0].segment.length() > 4.5); // the longer piece keeps the id
    }
    // Seen at times, and seen through at others until the end.
    void glassStays() {
        const Wall glass({4, 2}, {1, 2}), behind({8, 5}, {-4, 5});
        VectorMap map = mapOf(corridor({glass, behind}));
        Drive drive;
        for (int i = 0; i < 60; ++i)
            drive.see(corridor({i % 4 == 1 ? glass : behind}), {0.1 * i, 0, 0});
        const MapReviewCounts counts = MapReview()(map, drive.all());
        QCOMPARE(counts.removed + counts.cut, std::size_t(0));
        QVERIFY(hasWallAt(map, {2.5, 2}));
    }
    // A scan that sees nothing in a direction says nothing of it.
    void nothingSeenContradictsNothing() {
        VectorMap map = mapOf(corridor({upperWall}));
        Drive drive;
        drive.pass(corridor({}), 50);
        drive.pass({}, 50);
        QCOMPARE(MapReview()(map, drive.all()).contradicted, 0.0);
        QVERIFY(std::abs(lengthOf(map) - 20) < 1e-9);
        VectorMap none;
        QCOMPARE(MapReview()(none, drive.all()).merged, std::size_t(0));
        QCOMPARE(MapReview()(map, Drive().all()).removed, std::size_t(0));
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        Drive broken;
        for (int i = 0; i < 20; ++i)
            for (const Pose2D &pose : {Pose2D{nan, 0, 0}, Pose2D{0, 0, nan}, Pose2D{1e300, 0, 0}}) {
                broken.see(corridor({upperWall}), {});
                broken.edges.back().push_back(edgeOf({{nan, 1}, {-1, nan}}));
                broken.poses.back() = pose;
            }
        QCOMPARE(MapReview()(map, broken.all()).contradicted, 0.0);
    }

    void piecesJoinWhereNothingIsSeenThrough() {
        const Wall right({7, 2}, {3, 2}), left({2.7, 2}, {-3, 2}), far({4, 4}, {1, 4});
        Drive closed, open;
        closed.pass(corridor({right, left}), 20);
        open.pass(corridor({right, left, far}), 20);
        VectorMap map = mapOf(corridor({right, left}));
        QCOMPARE(MapReview()(map, closed.all()).joined, std::size_t(1));
        QCOMPARE(map.size(), std::size_t(2));
        QVERIFY(hasWallAt(map, {2.85, 2}));
        VectorMap slit = mapOf(corridor({right, left}));
        QCOMPARE(MapReview()(slit, open.all()).joined, std::size_t(0));
        QCOMPARE(slit.size(), std::size_t(3));
    }
    void cornersClose() {
        const std::vector<Wall> room = {{{-3.96, -3}, {3.95, -3}},
                                        {{4, -2.94}, {4, 2.9}},
                                        {{3.7, 3}, {-4, 3}},
                                        {{-4, 2.96}, {-4, -2.97}}};
        VectorMap map = mapOf(room);
        QCOMPARE(MapReview()(map, Drive().all()).corners, std::size_t(3));
        QVERIFY((map.slots()[0].segment.end() - Point(4, -3)).norm() < 1e-9);
        QCOMPARE(map.slots()[0].segment.end(), map.slots()[1].segment.begin());
        QCOMPARE(map.slots()[3].segment.end(), map.slots()[0].segment.begin());
        QCOMPARE(map.slots()[1].segment.end(), room[1].end()); // 0.3 m is a door, perhaps
        for (std::size_t i = 0; i < room.size(); ++i)
            QVERIFY(std::abs(room[i].across(map.slots()[i].segment.middle())) < 1e-12);
    }

    // The map moves as a whole and is numbered anew; one wall is new.
    void wallsKeepTheirIds() {
        const std::vector<Wall> walls = {{{-3, -2}, {7, -2}}, {{7, -2}, {7, 2}}, upperWall};
        const Wall added({-3, 2}, {-3, -2});
        Drive drive;
        drive.pass(walls, 5);
        drive.see({added}, {0, 0, 0});
        WallIds ids;
        VectorMap old = mapOf(walls);
        ids.remember(old, drive.all());
        const Transformation2D moved(20, -5, 0.7);
        for (Pose2D &pose : drive.poses)
            pose = (moved * Transformation2D(pose)).pose();
        VectorMap made = mapOf({moved * added, moved * walls[2], moved * walls[0], moved * walls[1]});
        made.takeChanges();
        ids.keep(made, drive.all());
        QCOMPARE(made.size(), std::size_t(4));
        for (std::size_t i = 0; i < walls.size(); ++i) {
            QCOMPARE(made.slots()[i].id, std::int64_t(i));
            QVERIFY((made.slots()[i].segment.middle() - (moved * walls[i]).middle()).norm() < 1e-9);
        }
        QVERIFY((made.slots()[3].segment.middle() - (moved * added).middle()).norm() < 1e-9);
        QCOMPARE(made.takeChanges(), (std::vector<int>{0, 1, 2, 3}));
        QCOMPARE(made.near({5, -20}, {30, 10}).size(), std::size_t(4));
    }
};
