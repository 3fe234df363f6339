#include "RandomPairs.h"

#include <vectorlib/similarity/EdgeSetComparator.h>

using namespace vectorlib;
using Segment = LineSegment2D<double>;

static const Segment unit({0, 0}, {1, 0});

static double pairByPair(const std::vector<SegmentPair> &pairs, const Transformation2D &t) {
    double sum = 0;
    for (const SegmentPair &p : pairs)
        sum += p.weight * areaCriterion(p.fixed, t * p.moving);
    return sum;
}

static Transformation2D anyMotion(std::mt19937 &random) {
    std::uniform_real_distribution<double> t(-3, 3), a(-pi, pi);
    return {t(random), t(random), a(random)};
}

// The similarity criterion of thesis 7.2.
class TestSimilarity : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void zeroExactlyOnTheLine() { // (7.12)
        QCOMPARE(areaCriterion(unit, Segment({5, 0}, {-7, 0})), 0.0);
        QVERIFY(areaCriterion(unit, Segment({5, 0.1}, {7, 0.1})) > 0); // parallel beside it: (7.8)
        QVERIFY(areaCriterion(unit, Segment({5, -1}, {5.1, 1})) > 0);  // its middle on it: (7.7)
    }

    void parallelogramAndMiddleOfKnownSegments() { // (Dy - Cy)^2 + (Dy + Cy)^2 beside (1, 0)
        QCOMPARE(areaCriterion(unit, Segment({2, 3}, {4, 5})), 4.0 + 64.0);
        QCOMPARE(areaCriterion(Segment({0, 0}, {2, 0}), Segment({2, 3}, {4, 5})), 4 * 68.0);
    }

    void slidingAlongTheLineChangesNothing() { // figures 7.5 and 7.6
        const Segment moving({0.2, 0.1}, {0.8, 0.5});
        for (double x : {-3.0, 0.5, 200.0})
            QVERIFY(std::abs(areaCriterion(unit, Transformation2D(x, 0, 0) * moving) -
                             areaCriterion(unit, moving)) < 1e-12);
    }

    void motionOfBothChangesNothing() { // (7.10)
        std::mt19937 random(1);
        const Segment moving({0.2, 0.1}, {0.8, 0.5});
        for (int i = 0; i < 100; ++i) {
            const Transformation2D t = anyMotion(random);
            QVERIFY(std::abs(areaCriterion(t * unit, t * moving) - areaCriterion(unit, moving)) < 1e-12);
        }
    }

    void constantTimeAgreesWithEveryPair() { // (7.18) against (7.16) and (7.17)
        std::mt19937 random(2);
        for (int i = 0; i < 500; ++i) {
            const Transformation2D truth = anyMotion(random);
            const std::vector<SegmentPair> pairs = randomPairs(truth, 1 + i % 50, random);
            EdgeSetComparator criterion;
            QCOMPARE(criterion.add(pairs), pairs.size());
            const Transformation2D t = anyMotion(random);
            const double expected = pairByPair(pairs, t);
            QVERIFY(std::abs(criterion(t) - expected) < 1e-11 * expected);
            QVERIFY(criterion(truth) < 1e-10 * criterion.pairs());
            QVERIFY(std::abs(criterion.expansion(t).value - expected) < 1e-11 * expected);
        }
    }

    // Erratum 11: one pair's sums, with magnitudes as printed in (7.18) and with signs.
    void magnitudesOfCrossProductsAreWrong() {
        const Segment moving({0, 0}, {1, -1});  // x cross y is negative
        const Transformation2D t(0, 0, pi / 4); // brings it onto the line
        const double dot = 1, cross = -1, c = t.cos(), s = t.sin();
        const auto parallelogram = [&](double xy) {
            return s * s * dot * dot + c * c * xy * xy + 2 * c * s * dot * xy;
        };
        QVERIFY(std::abs(parallelogram(cross)) < 1e-12);
        QVERIFY(parallelogram(std::abs(cross)) > 1.9);
        EdgeSetComparator criterion;
        criterion.add(unit, moving);
        QVERIFY(criterion(t) < 1e-12);
    }

    void derivativesAgreeWithDifferences() {
        std::mt19937 random(3);
        for (int i = 0; i < 50; ++i) {
            EdgeSetComparator criterion;
            criterion.add(randomPairs(anyMotion(random), 5, random));
            const Transformation2D t = anyMotion(random);
            const CriterionExpansion e = criterion.expansion(t);
            const double h = 1e-5, size = e.hessian.norm();
            for (int k = 0; k < 3; ++k) {
                const auto moved = [&](double d) {
                    return Transformation2D(t.x() + (k == 0) * d, t.y() + (k == 1) * d,
                                            t.alpha() + (k == 2) * d);
                };
                const double slope = (criterion(moved(h)) - criterion(moved(-h))) / (2 * h);
                QVERIFY(std::abs(slope - e.gradient(k)) < 1e-6 * size);
                const Eigen::Vector3d bend =
                    (criterion.expansion(moved(h)).gradient - criterion.expansion(moved(-h)).gradient) /
                    (2 * h);
                QVERIFY((bend - e.hessian.col(k)).norm() < 1e-6 * size);
            }
        }
    }

    void setsAreAddedAndRemoved() {
        std::mt19937 random(4);
        const auto first = randomPairs({1, 2, 3}, 20, random), second = randomPairs({-1, 0, 1}, 30, random);
        EdgeSetComparator a, b, both;
        a.add(first);
        b.add(second);
        both.add(first);
        both.add(second);
        const Transformation2D t(0.3, -0.4, 0.5);
        EdgeSetComparator sum = a;
        sum.add(b);
        QCOMPARE(sum.pairs(), 50);
        QVERIFY(std::abs(sum(t) - both(t)) < 1e-9 * both(t));
        QVERIFY(both.remove(b));
        for (const SegmentPair &p : first)
            QVERIFY(sum.remove(p));
        QVERIFY(std::abs(both(t) - a(t)) < 1e-9 * a(t));
        QVERIFY(std::abs(sum(t) - b(t)) < 1e-9 * b(t));
        QVERIFY(a.remove(a));
        QCOMPARE(a.pairs(), 0);
        QCOMPARE(a(t), 0.0);
    }

    void farFromTheOriginTheSumsCancel() { // erratum 13: why the frame must be near
        const auto errorAt = [](double offset) {
            const Transformation2D away(offset, offset, 0), t(0.01, -0.02, 0);
            std::mt19937 random(5);
            std::vector<SegmentPair> pairs = randomPairs({}, 10, random);
            for (SegmentPair &p : pairs)
                p = {away * p.fixed, away * p.moving, p.weight};
            EdgeSetComparator criterion;
            criterion.add(pairs);
            return std::abs(criterion(t) - pairByPair(pairs, t));
        };
        QVERIFY(errorAt(0) < 1e-12);
        QVERIFY(errorAt(1e6) > 1e-6);
    }

    void badInputAddsNothing_data() {
        const Rows<QLineF, QLineF, double> row("fixed", "moving", "weight");
        const QLineF good(0, 0, 1, 0), point(1, 1, 1, 1), nan(0, 0, qQNaN(), 1), infinite(0, 0, qInf(), 1);
        row("static of no length", point, good, 1.0);
        row("dynamic of no length", good, point, 1.0);
        row("static NaN", nan, good, 1.0);
        row("dynamic infinite", good, infinite, 1.0);
        row("weight 0", good, good, 0.0);
        row("weight below 0", good, good, -1.0);
        row("weight NaN", good, good, qQNaN());
        row("weight infinite", good, good, qInf());
        row("static infinite", infinite, good, 1.0);
        row("dynamic NaN", good, nan, 1.0);
        row("beyond a double", QLineF(0, 0, 1e100, 1e100), QLineF(0, 0, 1e100, -1e100), 1.0);
    }

    void badInputAddsNothing() {
        FETCH(QLineF, fixed, QLineF, moving, double, weight);
        const auto segment = [](const QLineF &l) { return Segment({l.x1(), l.y1()}, {l.x2(), l.y2()}); };
        EdgeSetComparator criterion;
        QCOMPARE(criterion({1, 2, 3}), 0.0); // an empty set is alike under every transformation
        QVERIFY(!criterion.remove({unit, unit, 1}));
        QVERIFY(!criterion.add(segment(fixed), segment(moving), weight));
        QCOMPARE(criterion.pairs(), 0);
        QCOMPARE(criterion({1, 2, 3}), 0.0);
        const SegmentPair sound{unit, Segment({0, 1}, {1, 2}), 1},
            bad{segment(fixed), segment(moving), weight}; // among others it adds nothing either
        QCOMPARE(criterion.add({sound, bad, sound}), std::size_t(2));
        QCOMPARE(criterion.pairs(), 2);
        QCOMPARE(criterion({}), 2 * areaCriterion(sound.fixed, sound.moving));
        criterion.clear();
        criterion.add(unit, unit);
        QVERIFY(std::isnan(criterion({qQNaN(), 0, 0})));
    }
};
