#include <vectorlib/mapping/ScanPairMatcher.h>
#include <vectorlib/simd/Lanes.h>

#include "tests/support/AllocationCounter.h"
#include "tests/vectorlib/ScanWorld.h"

using namespace vectorlib;
using Points = ScanWorld::Points;

// The motion between two scans by lines and points, and what it takes to be believed.
class TestScanPairMatcher : public QObject {
    Q_OBJECT

    static inline const auto room = ScanWorld::room, grove = ScanWorld::grove, corridor = ScanWorld::corridor;

    static EarSettings scanner() { return EarSettings::forScanner(pi, 361); }

    static double metres(const Transformation2D &a, const Transformation2D &b) {
        return (a.translation() - b.translation()).norm();
    }
    static double degrees(const Transformation2D &a, const Transformation2D &b) {
        return std::abs((a.inverse() * b).alpha()) * 180 / pi;
    }

private Q_SLOTS:
    void nearestIsThatOfAllPoints() {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> at(-5, 5);
        ScanIndex index;
        index.build(room().scan(Transformation2D(), random), 500);
        for (int i = 0; i < 2000; ++i) {
            const Vector2D<float> p(at(random), at(random));
            const float gate = 0.5f * 0.5f;
            float least = gate;
            for (int k = 0; k < index.size(); ++k)
                least = std::min(least, (index.point(k) - p).squaredNorm());
            const int found = index.nearest(p, gate);
            QCOMPARE(found >= 0, least < gate);
            if (found >= 0)
                QCOMPARE((index.point(found) - p).squaredNorm(), least);
        }
    }

    void nearestOfEightIsTheFirstOfTheNearest() {
        std::mt19937 random(2);
        std::uniform_real_distribution<float> at(-1, 1);
        for (int i = 0; i < 1000; ++i) {
            float x[8], y[8];
            int best = 0;
            for (int k = 0; k < 8; ++k) {
                x[k] = at(random);
                y[k] = at(random);
                if (std::hypot(x[k], y[k]) < std::hypot(x[best], y[best]))
                    best = k;
            }
            const simd::NearestOfEight nearest(x, y, 0, 0);
            const float least = x[best] * x[best] + y[best] * y[best];
            const float found = x[nearest.number] * x[nearest.number] + y[nearest.number] * y[nearest.number];
            QVERIFY(found <= least * 1.000002f && std::abs(nearest.squared - least) <= least * 2e-6f);
        }
        const float same[8] = {1, 1, 1, 1, 1, 1, 1, 1};
        QCOMPARE(simd::NearestOfEight(same, same, 0, 0).number, 0);
    }

    void motionIsFound_data() { falseAndTrue("round", "room", "round pillars"); }

    void motionIsFound() {
        QFETCH(bool, round);
        const ScanWorld world = round ? grove() : room();
        std::mt19937 random(3);
        std::normal_distribution<double> wheels(0, 0.08);
        ScanPairMatcher match;
        match.extract.segment.settings = scanner();
        int near = 0;
        double error = 0, errorByLines = 0;
        constexpr int runs = 50;
        for (int i = 0; i < runs; ++i) {
            const Transformation2D from(0, 0.02 * i - 0.5, 0.02 * i - 0.5);
            const Transformation2D motion(0.2, wheels(random), 3 * wheels(random));
            const Transformation2D odometry(0.2 + wheels(random), motion.y() + wheels(random),
                                            motion.alpha() + wheels(random));
            const ScanPairMatch &found =
                match(world.scan(from, random), world.scan(from * motion, random), odometry);
            near += found.accepted && metres(found.pose, motion) < 0.02 && degrees(found.pose, motion) < 0.3;
            error += metres(found.pose, motion);
            errorByLines += metres(found.byLines, motion);
        }
        QVERIFY2(near >= runs - 1, saying(near));
        QVERIFY2(!round || error < 0.6 * errorByLines, saying(error / errorByLines));
    }

    void corridorKeepsTheExpectedPlaceAlongIt() {
        std::mt19937 random(4);
        const Transformation2D motion(0.3, 0.1, 0.1), expected(0.35, 0, 0);
        const Points first = corridor().scan(Transformation2D(), random),
                     second = corridor().scan(motion, random);
        ScanPairMatcher match;
        match.extract.segment.settings = scanner();
        const ScanPairMatch found = match(first, second, expected);
        QVERIFY(found.accepted && !found.linesSuffice);
        QVERIFY(std::abs(found.pose.y() - 0.1) < 0.02 && degrees(found.pose, motion) < 0.5);
        QVERIFY(std::abs(found.pose.x() - 0.35) < 0.08);
        // Where the expectation says little, nothing fixes the place along the corridor.
        match.settings = ScanPairSettings::forPoorExpectation();
        QVERIFY(!match(first, second, expected).accepted);
    }

    void withoutOdometryAnyMotionIsFound() {
        std::mt19937 random(8);
        std::uniform_real_distribution<double> metre(-1.5, 1.5), turn(-pi, pi);
        const ScanWorld::Scanner all{720, 2 * pi, 0.01};
        ScanPairMatcher match;
        match.extract.segment.settings = EarSettings::forScanner(all.fieldOfView, 720);
        match.settings = ScanPairSettings::forPoorExpectation();
        for (int i = 0; i < 20; ++i) {
            const Transformation2D motion(metre(random), metre(random), turn(random));
            const ScanPairMatch &found =
                match(room().scan({}, random, all), room().scan(motion, random, all), Transformation2D());
            QVERIFY(found.accepted);
            QVERIFY(metres(found.pose, motion) < 0.02 && degrees(found.pose, motion) < 0.3);
        }
    }

    void anotherPlaceIsRefused() {
        std::mt19937 random(6);
        ScanPairMatcher match;
        match.extract.segment.settings = scanner();
        for (int i = 0; i < 20; ++i) {
            const Transformation2D pose(0, 0, 0.3 * i);
            QVERIFY(!match(room().scan(pose, random), grove().scan(Transformation2D(), random), {}).accepted);
        }
    }

    void wheelsThatSlipAreForgiven() {
        std::mt19937 random(7);
        ScanPairMatcher match;
        match.extract.segment.settings = scanner();
        const Transformation2D motion(0.1, 0, 0.05), expected(1.2, 0, 0.05);
        const ScanPairMatch &found =
            match(room().scan(Transformation2D(), random), room().scan(motion, random), expected);
        QVERIFY(found.accepted && found.searchedAgain);
        QVERIFY(metres(found.pose, motion) < 0.02 && degrees(found.pose, motion) < 0.3);
    }

    void nothingIsMadeOfNothing() {
        std::mt19937 random(8);
        const float nan = std::numeric_limits<float>::quiet_NaN(),
                    inf = std::numeric_limits<float>::infinity();
        const Points good = room().scan(Transformation2D(), random), empty, one{{1, 1}},
                     bad{{nan, 1}, {inf, -inf}, {3e38f, -3e38f}, {0, 0}, {-0.0f, nan}},
                     same(300, Vector2D<float>(2, 0));
        ScanPairMatcher match;
        for (const Points *a : {&good, &empty, &one, &bad, &same})
            for (const Points *b : {&empty, &one, &bad}) {
                QVERIFY(!match(*a, *b, {}).accepted);
                QVERIFY(!match(*b, *a, {}).accepted);
            }
        QVERIFY(!match(good, good, Transformation2D(nan, 0, 0)).accepted);
        QVERIFY(!match(good, good, Transformation2D(1e300, 0, 0)).accepted);
        QVERIFY(match(good, good, {}).accepted);
    }

    void steadyStateAllocatesNothing() {
        std::mt19937 random(9);
        const Points first = room().scan(Transformation2D(), random);
        const Points second = room().scan(Transformation2D(0.2, 0, 0.1), random);
        ScanPairMatcher match;
        match.extract.segment.settings = scanner();
        const std::size_t more = allocationsOnceGrown(4, [&] {
            match(first, second, {});
            match(second, first, {1, 1, 0}); // searched again
        });
        QCOMPARE(more, std::size_t(0));
    }
};
