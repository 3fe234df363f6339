#include "ScanWorld.h"

#include "vectorlib/observation/Discrepancy.h"

using namespace vectorlib;

/// What is compared when a solution is tested: expected views, unexplored space, discrepancy.
class TestViews : public QObject {
    Q_OBJECT

    using Segment = LineSegment2D<double>;
    using Point = Vector2D<double>;
    using View = std::vector<VisiblePart<double>>;

    /// The walls of a closed polygon, counter-clockwise.
    static std::vector<Segment> walls(const std::vector<Point> &corners) {
        return ScanWorld::of(corners).walls;
    }
    static std::vector<Segment> square(double half) {
        return walls({{-half, -half}, {half, -half}, {half, half}, {-half, half}});
    }
    static View look(const std::vector<Segment> &world, const Pose2D &pose = {},
                     const std::vector<Segment> &obstacles = {}) {
        return Observer<double>()(world, pose, obstacles);
    }
    static bool near(double a, double b, double tolerance = 1e-9) { return std::abs(a - b) <= tolerance; }
    static double rangeOf(const View &view, double angle) {
        double nearest = noHit;
        for (const auto &part : view)
            nearest = std::min(nearest, rayDistance({std::cos(angle), std::sin(angle)}, part.segment.begin(),
                                                    part.segment.end()));
        return nearest;
    }

private Q_SLOTS:
    void directionsKeepTheirOrder() {
        double last = -3;
        for (int degrees = -179; degrees <= 180; ++degrees) {
            const double angle = degrees * pi / 180;
            const double turn = turnOf(Point(std::cos(angle), std::sin(angle)) * (1 + degrees * 0.001));
            QVERIFY2(turn > last, QByteArray::number(degrees).constData());
            last = turn;
        }
        QCOMPARE(turnOf({-1, 0}), 2.0);
        QCOMPARE(turnOf({0, -3}), -1.0);
    }

    void thousandCrossingEdgesAgreeWithRays() {
        std::mt19937 random(newSeed());
        std::uniform_real_distribution<double> unit(-1, 1);
        int compared = 0;
        for (const double length : {0.3, 3.0, 30.0}) {
            std::vector<Segment> world;
            for (int i = 0; i < 1000; ++i) {
                const Point middle(20 * unit(random), 20 * unit(random));
                world.emplace_back(middle, middle + Point(unit(random), unit(random)) * length);
            }
            const View view = look(world);
            for (int i = 0; i < 2000; ++i) {
                const double angle = pi * unit(random);
                const Point direction(std::cos(angle), std::sin(angle));
                double nearest = noHit;
                bool front = false;
                for (const Segment &edge : world) {
                    const double distance = rayDistance(direction, edge.begin(), edge.end());
                    front = distance < nearest ? edge.begin().cross(edge.end()) > 0 : front;
                    nearest = std::min(nearest, distance);
                }
                const double seen = rangeOf(view, angle);
                if (nearest < noHit && front) {
                    QVERIFY(std::abs(seen - nearest) < 1e-6 * (1 + nearest));
                    ++compared;
                } else {
                    QVERIFY(seen == noHit);
                }
            }
        }
        QVERIFY(compared > 300);
    }

    void twoSidedWallShowsTheSideTowardsTheSensor() {
        for (const bool swapped : {false, true}) {
            std::vector<Segment> world = {Segment({2, -1}, {2, 1}), Segment({2, 1}, {2, -1})};
            if (swapped)
                std::swap(world[0], world[1]);
            QCOMPARE(look(world, {0, 0, 0}).size(), std::size_t(1));
            QCOMPARE(look(world, {4, 0, 0}).size(), std::size_t(1));
            QVERIFY(look(world, {0, 0, 0})[0].edge != look(world, {4, 0, 0})[0].edge);
        }
    }

    void sensorOnAnEdgeLooksPastIt() {
        std::vector<Segment> world = square(2);
        world.emplace_back(Point(-1, 0), Point(1, 0));
        double length = 0;
        for (const auto &part : look(world))
            length += part.segment.length();
        QVERIFY(near(length, 16));
    }

    void badEdgesAreNotSeen() {
        const double nan = std::numeric_limits<double>::quiet_NaN(), inf = noHit;
        std::vector<Segment> world = square(2);
        world.emplace_back(Point(1, nan), Point(1, 1));
        world.emplace_back(Point(1, -inf), Point(1, inf));
        world.emplace_back(Point(1, 1), Point(1, 1));
        world.emplace_back(Point(0, 0), Point(0, 0));
        QCOMPARE(look(world).size(), std::size_t(4));
        QVERIFY(look(world, {nan, 0, 0}).empty());
        QVERIFY(look({}).empty());
    }

    void obstaclesHideAndAreNotSeen() {
        const std::vector<Segment> wall = {Segment({2, -1}, {2, 1})};
        for (const bool turned : {false, true}) {
            const Segment obstacle({1, -0.25}, {1, 0.25});
            const View view = look(wall, {}, {turned ? obstacle.reversed() : obstacle});
            QCOMPARE(view.size(), std::size_t(2));
            QVERIFY(near(view[0].segment.length() + view[1].segment.length(), 1));
        }
    }

    // Thesis figure 7.19: what stands behind an obstacle was not seen and cannot be expected.
    void shadowOfAnObstacleIsUnexplored() {
        std::vector<Segment> world = square(5);
        for (const Segment &side : walls({{1, -1}, {1, 1}, {1.5, 1}, {1.5, -1}}))
            world.push_back(side);
        const View seen = look(world);
        std::vector<Segment> known;
        for (const auto &part : seen)
            known.push_back(part.segment);
        Frontier frontier;
        const std::vector<Segment> borders = frontier(seen);
        QCOMPARE(borders.size(), std::size_t(2)); // from the pillar's near corners to the wall
        for (const auto &part : look(known, {4.5, 4.5, 0}, borders))
            for (const double t : {0.1, 0.9}) {
                const Point p =
                    Transformation2D(4.5, 4.5, 0) * (part.segment.begin() * (1 - t) + part.segment.end() * t);
                const bool beside = std::abs(std::atan2(p.y, p.x)) > pi / 4 - 1e-6;
                QVERIFY2(beside, "a part of the shadow is expected");
            }
        QVERIFY(look(known, {4, 0, 0}, borders).empty()); // in the shadow nothing is known at all
        QVERIFY(!look(known, {4, 0, 0}).empty());
    }

    void wideGapIsUnexploredDownToTheSensor() {
        Observer<double> observer;
        observer.fieldOfView = 1.5 * pi;
        const View seen = observer(square(2), {0, 0, 0});
        Frontier frontier;
        const std::vector<Segment> &borders = frontier(seen);
        QCOMPARE(borders.size(), std::size_t(2));
        QVERIFY((borders[0].end() - Point()).norm() == 0 && (borders[1].begin() - Point()).norm() == 0);
        frontier.widestGap = 2;
        QCOMPARE(frontier(seen).size(), std::size_t(1));
    }

    void nothingSeenHasNoFrontier() { QVERIFY(Frontier()({}).empty()); }

    void equalViewsDoNotDiffer() {
        const View view = look(square(2), {0.3, -0.4, 1});
        const ViewComparison result = Discrepancy()(view, view);
        QVERIFY(near(result.discrepancy, 0) && near(result.common, 16) && near(result.angle, 2 * pi));
    }

    void differenceOfSquares() {
        Discrepancy compare;
        const ViewComparison result = compare(look(square(2)), look(square(2.1)));
        QVERIFY(near(result.discrepancy, 4.2 * 4.2 - 16) && near(result.common, 16));
        double area = 0;
        for (const SharedSector &s : compare.sectors())
            area += (s.observedRight.cross(s.observedLeft) - s.expectedRight.cross(s.expectedLeft)) / 2;
        QVERIFY(near(area, result.discrepancy));
    }

    void crossingSegmentsAreSplit() {
        // Two lines that cross straight ahead: the triangles to both sides are equal and must not cancel.
        const double slope = 0.25;
        const View a = look({Segment({2, -1}, {2, 1})});
        const View b = look({Segment({2 - slope, -1}, {2 + slope, 1})});
        const ViewComparison result = Discrepancy()(a, b);
        // On the right b cuts off less than a, on the left a cuts off less than b; by hand for the shared
        // angle.
        const auto triangle = [](Point p, Point q) { return std::abs(p.cross(q)) / 2; };
        const auto onB = [&](Point d) { return d * (2 / (d.x - slope * d.y)); };
        const Point right(2, -1), left = Point(2 + slope, 1) * (2 / (2 + slope));
        const double expected = triangle(right, {2, 0}) - triangle(onB(right), {2, 0}) +
                                triangle({2, 0}, onB(left)) - triangle({2, 0}, left);
        QVERIFY(near(result.discrepancy, expected));
        QVERIFY(expected > 0.2);
    }

    void onlySharedDirectionsCount() {
        const View a = look({Segment({2, -2}, {2, 0})}), b = look({Segment({3, -1.5}, {3, 3})});
        const ViewComparison result = Discrepancy()(a, b);
        QVERIFY(near(result.angle, std::atan(0.5)));
        QVERIFY(near(result.discrepancy, 0.5 * 0.5 * (9 - 4)) && near(result.common, 1));
    }

    void nothingSharedIsNoEvidence() {
        const View wall = look({Segment({2, -2}, {2, 0})});
        for (const ViewComparison &result :
             {Discrepancy()(wall, {}), Discrepancy()({}, wall), Discrepancy()({}, {}),
              Discrepancy()(wall, look({Segment({2, 0.5}, {2, 1})}))})
            QVERIFY(result.angle == 0 && result.discrepancy == 0 && result.common == 0);
    }

    void agreesWithRaysOnRandomViews() {
        std::mt19937 random(newSeed());
        std::uniform_real_distribution<double> unit(-1, 1);
        for (int round = 0; round < 20; ++round) {
            const auto made = [&] {
                std::vector<Segment> world;
                for (int i = 0; i < 12; ++i) {
                    const Point middle(4 * unit(random), 4 * unit(random));
                    world.emplace_back(middle, middle + Point(unit(random), unit(random)) * 3);
                }
                return look(world);
            };
            const View a = made(), b = made();
            const ViewComparison result = Discrepancy()(a, b);
            ViewComparison sum;
            const int rays = 20000;
            for (int i = 0; i < rays; ++i) {
                const double angle = 2 * pi * (i + 0.5) / rays - pi, ra = rangeOf(a, angle),
                             rb = rangeOf(b, angle);
                if (ra == noHit || rb == noHit)
                    continue;
                sum.angle += 2 * pi / rays;
                sum.discrepancy += pi / rays * std::abs(ra * ra - rb * rb);
                sum.common += pi / rays * std::min(ra * ra, rb * rb);
            }
            QVERIFY(near(result.angle, sum.angle, 0.02));
            QVERIFY(near(result.discrepancy, sum.discrepancy, 0.05 + 0.01 * sum.discrepancy));
            QVERIFY(near(result.common, sum.common, 0.05 + 0.01 * sum.common));
        }
    }
};
