#include "vectorlib/relations/MatchErrors.h"

using namespace vectorlib;

using Point = Vector2D<double>;
using Segment = LineSegment2D<double>;

static constexpr double degree = pi / 180;

static TypedSegment typed(Point begin, Point end) {
    TypedSegment t;
    t.segment = Segment(begin, end);
    return t;
}

static bool near(double a, double b, double tolerance = 1e-9) {
    return std::abs(a - b) < tolerance;
}

/// The measures of the pose-free thesis, chapter 6.
class TestMatchErrors : public QObject {
    Q_OBJECT

    MatchErrors errors_;
    const std::vector<CorrespondencePair> one_{{0, 0}};

private Q_SLOTS:
    void anglesAreCircular() {
        const PoseError e = MatchErrors::ofPose({3, 4, 359 * degree}, {0, 0, 1 * degree});
        QVERIFY(near(e.rotation, 2 * degree) && near(e.translation, 5));
        const PoseError step =
            MatchErrors::ofStep({0, 0, 170 * degree}, {1, 0, -170 * degree}, {5, 5, 0}, {6, 5, 15 * degree});
        QVERIFY(near(step.rotation, 5 * degree) && near(step.translation, 0));
    }

    void oldErrorsOfTheHeadingCountOnlyAsPublished() {
        std::mt19937 random(11);
        std::uniform_real_distribution<double> even(-3, 3);
        for (int i = 0; i < 100; ++i) {
            const Transformation2D motion(even(random), even(random), even(random));
            const Pose2D truth{even(random), even(random), even(random)}, estimate{0, 0, truth.theta + 0.1};
            const Pose2D trueNext = (Transformation2D(truth) * motion).pose(),
                         next = (Transformation2D(estimate) * motion).pose();
            const PoseError alone = MatchErrors::ofMotion(motion, motion),
                            published = MatchErrors::ofStep(estimate, next, truth, trueNext);
            QVERIFY(near(alone.rotation, 0, 1e-7) && near(alone.translation, 0));
            QVERIFY(near(published.rotation, 0));
            QVERIFY(near(published.translation, 2 * std::sin(0.05) * motion.translation().norm()));
        }
    }

    void areaOfAShiftedWall() {
        const std::vector<TypedSegment> wall{typed({1, 2}, {-1, 2})};
        QCOMPARE(errors_.area(one_, wall, wall, {}).error, 0.0);
        QCOMPARE(errors_.area(one_, wall, wall, {}).percent(), 0.0);
        // The reference is then at y = 1.9: a parallelogram of 2 m x 0.1 m behind a triangle that narrows to
        // it.
        const MatchedArea area = errors_.area(one_, wall, wall, Transformation2D(0, 0.1, 0));
        QVERIFY2(near(area.error, 0.2), saying(area.error));
        QVERIFY2(near(area.common, 1.9 * 1.9 / 2), saying(area.common));
        QVERIFY(near(area.percent(), 100 * 0.2 / (0.2 + 1.805)));
    }

    void areaOfCrossingWalls() {
        const std::vector<TypedSegment> level{typed({1, 2}, {-1, 2})}, tilted{typed({1, 2.2}, {-1, 1.8})};
        const MatchedArea area = errors_.area(one_, level, tilted, {});
        QVERIFY2(near(area.error, 2 * 0.5 * 0.2), saying(area.error));
    }

    void areaIsSeenFromTheCurrentPose() {
        // A wall that the current pose sees from behind has no area, though the reference sees it from the
        // front.
        const std::vector<TypedSegment> reference{typed({1, 2}, {-1, 2})};
        QVERIFY(errors_.area(one_, reference, reference, Transformation2D(0, 0.5, 0)).common > 0);
        QCOMPARE(errors_.area(one_, reference, reference, Transformation2D(0, 3, 0)).common, 0.0);
    }

    void areaGrowsWithTheError() { // figure 6.8
        std::mt19937 random(7);
        std::uniform_real_distribution<double> even(-1, 1);
        for (int trial = 0; trial < 50; ++trial) {
            const double y = 2 + even(random), length = 1.5 + even(random);
            const std::vector<TypedSegment> wall{typed({length, y}, {-length, y})};
            double last = -1;
            for (int i = 0; i <= 10; ++i) {
                const double area = errors_.area(one_, wall, wall, Transformation2D(0, 0.05 * i, 0)).error;
                QVERIFY(near(area, 2 * length * 0.05 * i) && area > last);
                last = area;
            }
        }
    }

    void whatCannotBeSeenHasNoArea_data() {
        const Rows<double, int> row("x", "index");
        row("not a number", std::numeric_limits<double>::quiet_NaN(), 0);
        row("infinite", std::numeric_limits<double>::infinity(), 0);
        row("huge", 1e300, 0);
        row("one point", -1.0, 0);
        row("no such segment", 1.0, 7);
        row("negative index", 1.0, -1);
    }

    void whatCannotBeSeenHasNoArea() {
        FETCH(double, x, int, index);
        const std::vector<TypedSegment> wall{typed({1, 2}, {-1, 2})}, other{typed({x, 2}, {-1, 2})};
        const MatchedArea area = errors_.area({{0, index}}, wall, other, {});
        QVERIFY(std::isfinite(area.error) && std::isfinite(area.common) && std::isfinite(area.percent()));
        if (x != 1e300)
            QCOMPARE(area.common, 0.0);
        QCOMPARE(errors_.area({}, wall, wall, {}).percent(), 0.0);
    }
};
