#include "RandomPairs.h"

#include <vectorlib/similarity/HausdorffDistances.h>

using namespace vectorlib;
using Segment = LineSegment2D<double>;

// The distances of segments that thesis 7.1.4 compares its criterion with.
class TestHausdorffDistances : public QObject {
    Q_OBJECT

    static inline const Segment unit{{0, 0}, {1, 0}};

    static Segment segment(const QLineF &l) { return Segment({l.x1(), l.y1()}, {l.x2(), l.y2()}); }

private Q_SLOTS:
    void knownSegments_data() {
        const Rows<QLineF, double, double, double> row("moving", "hausdorff", "modified", "perpendicular");
        row("itself", QLineF(0, 0, 1, 0), 0.0, 0.0, 0.0);
        row("on the line, apart", QLineF(3, 0, 4, 0), 3.0, 0.0, 0.0); // d1 = d2 = 0 in (7.5)
        row("parallel", QLineF(0, 2, 1, 2), 2.0, 0.0, 2.0);
        row("at right angles", QLineF(0, 0, 0, 2), 2.0, 1.0, 1.0);
        row("crossing in the middle", QLineF(0.5, -1, 0.5, 1), 1.0, 1.0, 0.5);
        row("30 degrees", QLineF(0, 0, std::sqrt(3), 1), 1.2393, 0.5, 0.5);
        row("sloping above", QLineF(0, 1, 1, 3), 3.0, std::sqrt(0.8), std::sqrt(1.25));
    }

    void knownSegments() {
        FETCH(QLineF, moving, double, hausdorff, double, modified, double, perpendicular);
        const auto near = [](double found, double expected) {
            return QTest::qVerify(std::abs(found - expected) < 1e-4, "near",
                                  qPrintable(QString::number(found)), __FILE__, __LINE__);
        };
        QVERIFY(near(hausdorffDistance(unit, segment(moving)), hausdorff));
        QVERIFY(near(modifiedHausdorffDistance(unit, segment(moving)), modified));
        QVERIFY(near(perpendicularHausdorffDistance(unit, segment(moving)), perpendicular));
    }

    // (7.1) as it stands: over many points of one the nearest of many of the other.
    void farthestPointIsAnEnd() {
        const unsigned seed = std::random_device()();
        std::mt19937 random(seed);
        constexpr int parts = 100;
        for (const SegmentPair &pair : randomPairs({1, 0.5, 0.7}, 50, random)) {
            const auto oneWay = [](const Segment &from, const Segment &to) {
                double most = 0;
                for (int i = 0; i <= parts; ++i) {
                    double least = 1e300;
                    for (int k = 0; k <= parts; ++k)
                        least = std::min(least,
                                         (from.begin() + (from.end() - from.begin()) * (double(i) / parts) -
                                          to.begin() - (to.end() - to.begin()) * (double(k) / parts))
                                             .norm());
                    most = std::max(most, least);
                }
                return most;
            };
            const double expected =
                std::max(oneWay(pair.fixed, pair.moving), oneWay(pair.moving, pair.fixed));
            const double found = hausdorffDistance(pair.fixed, pair.moving);
            QVERIFY2(std::abs(found - expected) < 0.03, saying("seed %1", seed));
        }
    }

    void printedSineFallsBelowZero() { // (7.3) in the range of figures 7.3 to 7.5
        for (double angle = 0; angle < 2 * pi; angle += 0.1) {
            const double found = modifiedHausdorffDistance(unit, Transformation2D(0, 0, angle) * unit);
            QVERIFY(std::abs(found - std::abs(std::sin(angle))) < 1e-12);
        }
        QVERIFY(std::sin(4.0) < 0); // as printed
    }

    void printedHalfHalvesTheDistanceOfParallels() { // (7.6)
        const Segment above = Transformation2D(0, 3, 0) * unit;
        QCOMPARE(perpendicularHausdorffDistance(unit, above), 3.0);
        QCOMPARE(hausdorffDistance(unit, above), 3.0);
        const double weight = 0.5, printed = 0.5 * (weight * 3 + weight * 3);
        QCOMPARE(printed, 1.5);
    }

    void badInputIsNoDistance_data() {
        const Rows<QLineF> row("moving");
        row("no length", QLineF(1, 1, 1, 1));
        row("NaN", QLineF(0, 0, qQNaN(), 1));
        row("infinite", QLineF(0, 0, qInf(), 1));
    }

    void badInputIsNoDistance() {
        QFETCH(QLineF, moving);
        const Segment bad = segment(moving);
        for (const auto distance :
             {hausdorffDistance, modifiedHausdorffDistance, perpendicularHausdorffDistance}) {
            QVERIFY(std::isnan(distance(unit, bad)));
            QVERIFY(std::isnan(distance(bad, unit)));
        }
    }
};
