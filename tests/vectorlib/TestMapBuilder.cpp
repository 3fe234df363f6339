#include <vectorlib/mapping/MapBuilder.h>
#include <vectorlib/motion/MotionModel.h>

using namespace vectorlib;
using Segment = LineSegment2D<double>;

static EdgeRaw2D straight(Vector2D<double> from, Vector2D<double> to) {
    std::vector<Vector2D<double>> points;
    for (int i = 0; i <= 50; ++i)
        points.push_back(from + (to - from) * (i / 50.0));
    return {TlsSums::of(points.begin(), points.end()), Segment(from, to), 0};
}

class TestMapBuilder : public QObject {
    Q_OBJECT

    // A room of 8 m x 6 m with a box in it; free space on the left of every wall.
    static inline const std::vector<Segment> room{
        {{-4, -3}, {4, -3}},    {{4, -3}, {4, 3}},   {{4, 3}, {-1, 3}},  {{-1, 3}, {-1, 2}},
        {{-1, 2}, {-4, 2}},     {{-4, 2}, {-4, -3}}, {{2, 1}, {2, 1.8}}, {{2, 1.8}, {2.9, 1.8}},
        {{2.9, 1.8}, {2.9, 1}}, {{2.9, 1}, {2, 1}}};

    static std::vector<Vector2D<float>> scan(const Pose2D &pose, int rays, double sigma,
                                             std::mt19937 &random) {
        std::normal_distribution<double> noise;
        std::vector<Vector2D<float>> points;
        for (int i = 0; i < rays; ++i) {
            const double angle = 2 * pi * i / rays, world = pose.theta + angle;
            const Vector2D<double> d(std::cos(world), std::sin(world)), from(pose.x, pose.y);
            double range = 1e9;
            for (const Segment &wall : room) {
                const double across = d.cross(wall.direction());
                if (std::abs(across) < 1e-12)
                    continue;
                const double r = (wall.begin() - from).cross(wall.direction()) / across;
                const double t = wall.along(from + d * r);
                if (r > 0 && t >= 0 && t <= wall.length())
                    range = std::min(range, r);
            }
            range += sigma * noise(random);
            points.emplace_back(float(range * std::cos(angle)), float(range * std::sin(angle)));
        }
        return points;
    }

    static double distance(const Pose2D &a, const Pose2D &b) { return std::hypot(a.x - b.x, a.y - b.y); }

private Q_SLOTS:
    void mergedEdgeIsTheFitOfAllPoints() {
        std::mt19937 random(1);
        std::normal_distribution<double> noise(0, 0.02);
        std::vector<Vector2D<double>> first, second, all;
        for (int i = 0; i < 100; ++i) {
            first.emplace_back(0.02 * i, 1 + noise(random));
            second.emplace_back(1 + 0.02 * i, 1 + noise(random));
        }
        all = first;
        all.insert(all.end(), second.begin(), second.end());
        const auto edge = [](const std::vector<Vector2D<double>> &points) {
            return EdgeRaw2D(TlsSums::of(points.begin(), points.end()),
                             Segment(points.front(), points.back()), 0.02);
        };
        VectorMap map;
        const int number = map.add(edge(first));
        QVERIFY(map.merge(number, edge(second)));
        const EdgeRaw2D &joint = map.slots()[0];
        const TlsLine fit = fitLine(edge(all).sums);
        QVERIFY(std::abs(joint.sigma * joint.sigma - fit.variance) < 1e-12);
        QVERIFY(std::abs(fit.line.signedDistance(joint.segment.begin())) < 1e-9);
        QVERIFY(std::abs(joint.segment.length() - 2.98) < 0.03);
        QCOMPARE(map.slots()[0].observations, 2);
    }

    void collinearEdgesJoin() {
        VectorMap map;
        map.add(straight({0, 0}, {1, 0}));
        map.add(straight({2.05, 0.01}, {3, 0}));
        const int middle = map.add(straight({1.05, 0}, {2, 0.01}));
        QCOMPARE(map.consolidate(middle), 2);
        QCOMPARE(map.size(), std::size_t(1));
        QCOMPARE(map.slots()[std::size_t(middle)].sums.n, 153.0);
        QCOMPARE(map.takeChanges(), (std::vector<int>{0, 1, 2}));
        QVERIFY(map.takeChanges().empty());
        QVERIFY(!map.merge(0, straight({0, 0}, {1, 0}))); // it is not there any more
        QCOMPARE(map.slots()[0].observations, std::int64_t(0));
        QCOMPARE(map.size(), std::size_t(1));
    }

    void parallelWallsStayApart() {
        VectorMap map;
        map.add(straight({0, 0}, {3, 0}));
        QCOMPARE(map.consolidate(map.add(straight({0, 0.12}, {3, 0.12}))), 0); // both sides face the same way
        QCOMPARE(map.consolidate(map.add(straight({3, 0.02}, {0, 0.02}))),
                 0); // the other side of a thin wall
        QCOMPARE(map.size(), std::size_t(3));
    }

    void mergeRefusesWhatIsNoLine() {
        VectorMap map;
        const int number = map.add(straight({0, 0}, {1, 0}));
        QVERIFY(!map.merge(number, straight({1, 0}, {1.5, 0.8})));
        QCOMPARE(map.slots()[0].segment.length(), 1.0);
    }

    void gridFindsWhatTouchesTheBox() {
        std::mt19937 random(2);
        std::uniform_real_distribution<double> u(-30, 30), small(-6, 6);
        SegmentGrid grid;
        std::vector<Segment> segments;
        for (int i = 0; i < 400; ++i) {
            const Vector2D<double> p(u(random), u(random));
            segments.emplace_back(p, p + Vector2D<double>(small(random), small(random)));
            grid.insert(i, segments.back());
        }
        for (int k = 0; k < 50; ++k) {
            const double large = k % 5 == 0 ? 2000 : 1; // more cells than there are
            const Vector2D<double> low(u(random), u(random)), high = low + Vector2D<double>(3, 2) * large;
            std::vector<int> found(400, 0);
            grid.query(low, high, [&](int i) { ++found[std::size_t(i)]; });
            for (std::size_t i = 0; i < segments.size(); ++i) {
                QVERIFY(found[i] <= 1);
                for (double t = 0; t <= 1; t += 0.01) {
                    const Vector2D<double> p =
                        segments[i].begin() + (segments[i].end() - segments[i].begin()) * t;
                    const bool inside = p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y;
                    QVERIFY(!inside || found[i] == 1);
                }
            }
        }
    }

    void trackerRecoversTheDisplacement_data() {
        const Rows<double, double, double> row("dx", "dy", "dalpha");
        row("none", 0.0, 0.0, 0.0);
        row("small", 0.05, -0.03, 0.02);
        row("far", 0.3, 0.2, 0.1);
        row("turned", 0.1, 0.1, 0.35);
    }

    void trackerRecoversTheDisplacement() {
        FETCH(double, dx, double, dy, double, dalpha);
        std::mt19937 random(3);
        for (int i = 0; i < 20; ++i) {
            const Pose2D truth{-1.5 + 0.1 * i, -1.0 + 0.05 * i, 0.3 * i};
            EdgeExtractor extract;
            CorrespondenceTracker track;
            track.settings.expectedDeviationXY = track.settings.expectedDeviationAlpha = 0.3;
            const Transformation2D pose(truth);
            const Match &match = track(room, extract(scan(truth, 1000, 0.01, random)),
                                       pose * Transformation2D(dx, dy, dalpha));
            QVERIFY(match.accepted);
            QVERIFY2(distance(match.pose.pose(), truth) < 0.02,
                     saying("pose %1: %2 m off, %3 pairs", i, distance(match.pose.pose(), truth),
                            match.pairs.size()));
            QVERIFY(std::abs(wrapAngle(match.pose.alpha() - truth.theta)) < 0.005);
            QVERIFY(match.reliability > 0.8);
        }
    }

    void trackerWithNothingToMatch() {
        CorrespondenceTracker track;
        EdgeExtractor extract;
        std::mt19937 random(4);
        const auto edges = extract(scan({}, 1000, 0.01, random));
        QVERIFY(!track({}, edges, Transformation2D()).accepted);
        QVERIFY(!track(room, {}, Transformation2D()).accepted);
        QVERIFY(track(room, {}, Transformation2D(1, 2, 3)).pose.isFinite());
    }

    void corridorKeepsTheExpectedPlaceAlongIt() {
        const std::vector<Segment> corridor{{{-20, -1}, {20, -1}}, {{20, 1}, {-20, 1}}};
        std::vector<EdgeRaw2D> seen{straight({-3, -1.05}, {3, -1.05}), straight({3, 0.95}, {-3, 0.95})};
        CorrespondenceTracker track;
        const Match &match = track(corridor, seen, Transformation2D(5, 0, 0));
        QVERIFY(match.accepted);
        QVERIFY(match.reliability < 0.01);
        QVERIFY(std::abs(match.pose.x() - 5) < 1e-6);
        QVERIFY(std::abs(match.pose.y() - 0.05) < 0.005);
    }

    void tracksAroundTheRoom() {
        std::mt19937 random(5);
        MapBuilder builder;
        MotionModel motion;
        for (int i = 0; i <= 200; ++i) {
            const double a = 2 * pi * i / 200;
            const Pose2D truth{-1 + 1.5 * std::cos(a), -0.8 + 1.2 * std::sin(a), a};
            if (i == 0)
                motion.reset(truth);
            const ScanReport &report =
                builder.process(scan(truth, 1000, 0.01, random), motion.predict(0.1 * i));
            QVERIFY2(report.outcome == ScanReport::Outcome::Matched, saying("scan %1", i));
            QVERIFY2(distance(report.pose, truth) < 0.03, saying("scan %1", i));
            motion.update(report.pose, 0.1 * i);
        }
        QVERIFY2(builder.map.size() <= 20, saying("%1 edges", builder.map.size()));
    }

    void theScanBeforeMakesUpForWheelsThatSlip() {
        // The expected pose is always 0.9 m off: farther than the tracker searches in the map.
        for (const bool matchPrevious : {false, true}) {
            std::mt19937 random(5);
            MapBuilder builder;
            builder.settings.matchPrevious = matchPrevious;
            int found = 0;
            for (int i = 0; i <= 40; ++i) {
                const double a = 2 * pi * i / 40;
                const Pose2D truth{-1 + 1.5 * std::cos(a), -0.8 + 1.2 * std::sin(a), a};
                Pose2D expected = i == 0 ? truth : builder.report().pose;
                expected.x += i == 0 ? 0 : 0.9;
                const ScanReport &report = builder.process(scan(truth, 1000, 0.01, random), expected);
                found +=
                    report.outcome == ScanReport::Outcome::Matched && distance(report.pose, truth) < 0.03;
            }
            QVERIFY2(matchPrevious ? found == 41 : found < 20, saying(found));
        }
    }

    void scanOfNothingIsSkipped() {
        MapBuilder builder;
        QCOMPARE(builder.process(std::vector<Vector2D<float>>(), {1, 2, 3}).outcome,
                 ScanReport::Outcome::Skipped);
        QCOMPARE(builder.report().pose.x, 1.0);
        QVERIFY(builder.map.isEmpty());
    }

    void strangePlaceIsLost() {
        std::mt19937 random(6);
        MapBuilder builder;
        builder.process(scan({}, 1000, 0.01, random), {});
        const std::size_t before = builder.map.size();
        QCOMPARE(builder.process(scan({}, 1000, 0.01, random), {100, 100, 0}).outcome,
                 ScanReport::Outcome::Lost);
        QCOMPARE(builder.map.size(), before);
    }
};
