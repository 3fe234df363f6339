#include "ScanWorld.h"

#include "vectorlib/observation/Observer.h"
#include "vectorlib/observation/SimulatedScanner.h"

using namespace vectorlib;

class TestObservation : public QObject {
    Q_OBJECT

    using Segment = LineSegment2D<double>;
    using Point = Vector2D<double>;

    /// A room of 4 m x 2 m about the origin, free inside, with a square pillar at (1, 0), 0.4 m wide.
    static std::vector<Segment> room() {
        const auto closed = [](const std::vector<Point> &corners) { return ScanWorld::of(corners).walls; };
        std::vector<Segment> world = closed({{-2, -1}, {2, -1}, {2, 1}, {-2, 1}});
        for (const Segment &edge : closed({{0.8, -0.2}, {0.8, 0.2}, {1.2, 0.2}, {1.2, -0.2}}))
            world.push_back(edge);
        return world;
    }

    static bool near(Point a, Point b, double tolerance = 1e-9) { return (a - b).norm() < tolerance; }

    /// Total angle under which the parts are seen from the origin.
    static double seenAngle(const std::vector<VisiblePart<double>> &parts) {
        double sum = 0;
        for (const auto &part : parts)
            sum += std::abs(wrapAngle(std::atan2(part.segment.end().y, part.segment.end().x) -
                                      std::atan2(part.segment.begin().y, part.segment.begin().x)));
        return sum;
    }

private Q_SLOTS:
    void anEmptyRoomIsSeenWhole() {
        std::vector<Segment> walls = room();
        walls.resize(4);
        Observer<double> observer;
        const auto &parts = observer(walls, {0.5, 0.25, 0.7});
        QCOMPARE(parts.size(), std::size_t(4));
        const Transformation2D toWorld(Pose2D{0.5, 0.25, 0.7});
        for (const auto &part : parts) {
            QVERIFY(near(toWorld * part.segment.begin(), walls[part.edge].begin()));
            QVERIFY(near(toWorld * part.segment.end(), walls[part.edge].end()));
        }
    }

    void pillarsHideTheWallBehind() {
        Observer<double> observer;
        const auto &parts = observer(room(), {0, 0, 0});
        // The near face of the pillar hides half a metre of the far wall to each side: 2 * 0.2 / 0.8.
        QCOMPARE(parts.size(), std::size_t(6));
        double far = 0;
        for (const auto &part : parts) {
            if (part.edge == 1)
                far += part.segment.length();
            QVERIFY(part.edge <= 4); // of the pillar only the face towards the sensor
        }
        QVERIFY(std::abs(far - 1.0) < 1e-9);
        QVERIFY(std::abs(seenAngle(parts) - 2 * pi) < 1e-9);
    }

    void wrongSidesHideOnly() {
        Observer<double> observer;
        std::vector<Segment> world = {Segment({2, -1}, {2, 1}), Segment({1, 0.5}, {1, -0.5})};
        const auto &parts = observer(world, {0, 0, 0});
        QVERIFY(parts.empty()); // the second edge shows its right side and hides the first
        world[1] = Segment({1, 0.5}, {1, 0});
        const auto &half = observer(world, {0, 0, 0});
        QCOMPARE(half.size(), std::size_t(1));
        QVERIFY(near(half[0].segment.begin(), {2, -1}) && near(half[0].segment.end(), {2, 0}));
    }

    void crossingEdgesHideEachOther() {
        Observer<double> observer;
        const std::vector<Segment> world = {Segment({1, -1}, {3, 1}), Segment({3, -1}, {1, 1})};
        const auto &parts = observer(world, {0, 0, 0});
        QCOMPARE(parts.size(), std::size_t(2));
        QVERIFY(near(parts[0].segment.begin(), {1, -1}) && near(parts[0].segment.end(), {2, 0}));
        QVERIFY(near(parts[1].segment.begin(), {2, 0}) && near(parts[1].segment.end(), {1, 1}));
    }

    void fieldOfViewCuts() {
        Observer<double> observer;
        observer.fieldOfView = pi / 2;
        const auto &parts = observer({Segment({2, -5}, {2, 5})}, {0, 0, 0});
        QCOMPARE(parts.size(), std::size_t(1));
        QVERIFY(near(parts[0].segment.begin(), {2, -2}) && near(parts[0].segment.end(), {2, 2}));
    }

    void rangeCuts() {
        Observer<double> observer;
        observer.maxRange = 5;
        const auto &parts = observer({Segment({3, -50}, {3, 50}), Segment({-6, 1}, {-6, -1})}, {0, 0, 0});
        QCOMPARE(parts.size(), std::size_t(1));
        QVERIFY(near(parts[0].segment.begin(), {3, -4}) && near(parts[0].segment.end(), {3, 4}));
    }

    void agreesWithRaysAtRandomPoses() {
        std::mt19937 random(newSeed());
        std::uniform_real_distribution<double> unit(-1, 1);
        Observer<double> observer;
        for (int round = 0; round < 100; ++round) {
            std::vector<Segment> world;
            for (int i = 0; i < 15; ++i) {
                const Point middle(5 * unit(random), 5 * unit(random));
                world.emplace_back(middle + Point(2 * unit(random), 2 * unit(random)), middle);
            }
            const Pose2D pose{unit(random), unit(random), 3 * unit(random)};
            const Transformation2D toSensor = Transformation2D(pose).inverse();
            const auto &parts = observer(world, pose);
            for (int i = 0; i < 200; ++i) {
                const double angle = pi * unit(random);
                const Point direction(std::cos(angle), std::sin(angle));
                double nearest = noHit, seen = noHit;
                bool front = false;
                for (const Segment &edge : world) {
                    const Segment local = toSensor * edge;
                    const double distance = rayDistance(direction, local.begin(), local.end());
                    front = distance < nearest ? local.begin().cross(local.end()) > 0 : front;
                    nearest = std::min(nearest, distance);
                }
                for (const auto &part : parts)
                    seen = std::min(seen, rayDistance(direction, part.segment.begin(), part.segment.end()));
                if (nearest < noHit && front)
                    QVERIFY(std::abs(seen - nearest) < 1e-6 * (1 + nearest));
                else
                    QVERIFY(seen == noHit);
            }
        }
    }

    void scansLieOnTheWalls() {
        SimulatedScanner<float> scanner;
        scanner.sigma = 0;
        std::vector<LineSegment2D<float>> world;
        for (const Segment &edge : room())
            world.emplace_back(edge);
        const Pose2D pose{-0.4, 0.3, 2};
        const auto &points = scanner(world, pose);
        QCOMPARE(points.size(), std::size_t(720));
        const Transformation2D toWorld(pose);
        double lastAngle = -4;
        for (const auto &point : points) {
            float nearest = 1;
            for (const auto &edge : world)
                nearest = std::min(nearest, edge.distance(toWorld * point));
            QVERIFY(nearest < 1e-5f);
            const double angle = std::atan2(point.y, point.x);
            QVERIFY(angle > lastAngle || lastAngle > 3.1);
            lastAngle = angle;
        }
    }

    void scanNoiseAndOutliers() {
        SimulatedScanner<double> scanner(7);
        scanner.rays = 20000;
        scanner.sigma = 0.02;
        scanner.fieldOfView = 0.01; // a wall straight ahead, 5 m away
        const std::vector<Segment> wall = {Segment({5, -1}, {5, 1})};
        double sum = 0, squares = 0;
        for (const Point &point : scanner(wall, {0, 0, 0})) {
            sum += point.x - 5;
            squares += (point.x - 5) * (point.x - 5);
        }
        QVERIFY(std::abs(sum / 20000) < 0.001);
        QVERIFY(std::abs(std::sqrt(squares / 20000) - 0.02) < 0.001);
        scanner.outliers = 0.1;
        int before = 0;
        for (const Point &point : scanner(wall, {0, 0, 0}))
            before += point.x < 4.8;
        QVERIFY(before > 1700 && before < 2200);
        scanner.outliers = 0;
        scanner.maxRange = 4;
        QVERIFY(scanner(wall, {0, 0, 0}).empty());
        scanner.maxRange = 100;
        scanner.minRange = 6;
        QVERIFY(scanner(wall, {0, 0, 0}).empty());
    }

    void directionsHaveNoise() {
        SimulatedScanner<double> scanner(5);
        scanner.rays = 20001;
        scanner.fieldOfView = 0.2;
        scanner.sigma = 0;
        scanner.angleSigma = 0.01;
        // A wall at 45 degrees, 5 m ahead: the range tells the direction that the ray really had.
        const std::vector<Segment> wall = {Segment({10, -5}, {0, 5})};
        double sum = 0, squares = 0;
        int ray = 0;
        for (const Point &point : scanner(wall, {0, 0, 0})) {
            const double told = std::atan2(point.y, point.x),
                         real = std::acos(5 / std::sqrt(2.0) / point.norm());
            QVERIFY(std::abs(told - scanner.angle(ray++)) < 1e-9);
            const double error = pi / 4 - real - told;
            sum += error;
            squares += error * error;
        }
        QCOMPARE(ray, scanner.rays);
        QVERIFY2(std::abs(sum / ray) < 0.0005, saying(sum / ray));
        QVERIFY(std::abs(std::sqrt(squares / ray) - 0.01) < 0.0005);
    }

    void evenNoiseEnds() {
        SimulatedScanner<double> scanner(9);
        scanner.rays = 20000;
        scanner.sigma = 0.02;
        scanner.noise = NoiseShape::Even;
        scanner.fieldOfView = 0.001; // a wall straight ahead, 5 m away
        double largest = 0, squares = 0;
        for (const Point &point : scanner({Segment({5, -1}, {5, 1})}, {0, 0, 0})) {
            largest = std::max(largest, std::abs(point.x - 5));
            squares += (point.x - 5) * (point.x - 5);
        }
        QVERIFY2(largest < 0.02 * std::sqrt(3.0) + 1e-5 && largest > 0.0345, saying(largest));
        QVERIFY(std::abs(std::sqrt(squares / 20000) - 0.02) < 0.0005);
    }

    void scansRepeatWithTheirSeed() {
        SimulatedScanner<double> a(3), b(3), c(4);
        QVERIFY(a(room(), {0, 0, 0}) == b(room(), {0, 0, 0}));
        QVERIFY(a(room(), {0, 0, 0}) != c(room(), {0, 0, 0}));
    }

    void raysCoverTheField() {
        SimulatedScanner<double> scanner;
        scanner.rays = 4;
        QCOMPARE(scanner.angle(0), -pi);
        QCOMPARE(scanner.angle(3), pi / 2);
        scanner.fieldOfView = pi;
        scanner.rays = 181;
        QCOMPARE(scanner.angle(0), -pi / 2);
        QCOMPARE(scanner.angle(180), pi / 2);
    }
};
