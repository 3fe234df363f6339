#include <vectorlib/correspondence/QuadrangleMatcher.h>

using namespace vectorlib;
using Segment = LineSegment2D<double>;
using Segments = std::vector<Segment>;

static const Segments room{Segment({0, 0}, {5, 0}), Segment({5, 0}, {5, 4}), Segment({5, 4}, {0, 4}),
                           Segment({0, 4}, {0, 0})};

// The matcher of overview paper 2.2.
class TestQuadrangleMatcher : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void edgesFallIntoThreeGroups() {
        OverlapSelection select;
        const Segments fixed{Segment({0, 0}, {3, 0}), Segment({0, 0.3}, {3, 0.3}), Segment({6, 0}, {6, 3})};
        const Segments moving{Segment({1, 0.1}, {2, 0.1}),  // two partners, the nearer is 0.1 m off
                              Segment({6.2, 1}, {6.2, 2}),  // one
                              Segment({20, 20}, {22, 20})}; // none
        const auto pairs = select(fixed, moving);
        QCOMPARE(pairs.size(), std::size_t(2));
        QVERIFY(pairs[0].fixed == 2 && pairs[0].moving == 1); // the sure one first
        QVERIFY(pairs[1].fixed == 0 && pairs[1].moving == 0);
        QCOMPARE(select.alone(), std::size_t(1));
        QCOMPARE(select.sure(), std::size_t(1));
        QCOMPARE(select.ambiguous(), std::size_t(1));
    }

    void anEdgeOfTheSecondGroupIsNotTakenAgain() {
        OverlapSelection select;
        const Segments fixed{Segment({0, 0}, {3, 0}), Segment({0, 0.4}, {3, 0.4})};
        const Segments moving{Segment({1, 0.15}, {2, 0.15}),  // both are near, the lower one nearer
                              Segment({1, -0.3}, {2, -0.3})}; // only the lower one
        const auto pairs = select(fixed, moving);
        QCOMPARE(pairs.size(), std::size_t(2));
        QVERIFY(pairs[0].fixed == 0 && pairs[0].moving == 1);
        QVERIFY(pairs[1].fixed == 1 && pairs[1].moving == 0);
    }

    void shortEdgesTakeNoPart() {
        OverlapSelection select;
        QVERIFY(select({Segment({0, 0}, {0.4, 0})}, {Segment({0, 0}, {1, 0})}).empty());
        QVERIFY(select({Segment({0, 0}, {1, 0})}, {Segment({0, 0}, {0.4, 0})}).empty());
        QCOMPARE(select.alone(), std::size_t(0)); // nor is it counted
    }

    void findsTheMotionOfARoom() {
        const unsigned seed = std::random_device()();
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> shift(-0.2, 0.2), turn(-0.1, 0.1);
        QuadrangleMatcher match;
        for (int i = 0; i < 50; ++i) {
            const Transformation2D truth(2 + shift(random), 1 + shift(random), 0.5 + turn(random));
            Segments seen;
            for (const Segment &wall : room)
                seen.push_back(truth.inverse() * wall.part(0.5, wall.length() - 0.5));
            const QuadrangleMatch &found = match(room, seen, Transformation2D(2, 1, 0.5));
            QVERIFY(found.accepted);
            QCOMPARE(found.pairs.size(), room.size());
            QVERIFY2((found.pose.translation() - truth.translation()).norm() < 1e-3,
                     saying("seed %1, try %2", seed, i));
            QVERIFY(std::abs((truth.inverse() * found.pose).alpha()) < 1e-3);
        }
    }

    void parallelEdgesAreNoMatch() { // the direction of a corridor stays open
        QuadrangleMatcher match;
        const Transformation2D expected(0.1, 0.1, 0);
        const QuadrangleMatch &found = match({room[0], room[2]}, {room[0], room[2]}, expected);
        QVERIFY(!found.accepted);
        QCOMPARE(found.pairs.size(), std::size_t(2));
        QCOMPARE(found.pose.x(), expected.x());
        QVERIFY(!match({}, {}, expected).accepted);
    }

    void theOrderOfEdgesCountsNothing() {
        // Between the first edge and each other 0.12 rad, between those two 0.24: over the 0.17 of skew
        // edges.
        const auto edge = [](double x, double angle) {
            return Segment({x, 0}, {x + 4 * std::cos(angle), 4 * std::sin(angle)});
        };
        Segments edges{edge(0, 0), edge(10, 0.12), edge(20, -0.12)};
        QuadrangleMatcher match;
        for (int order = 0; order < 3; ++order) {
            QVERIFY2(match(edges, edges, {}).accepted, saying(order));
            std::rotate(edges.begin(), edges.begin() + 1, edges.end());
        }
    }

    void hostileEdgesDoNoHarm() {
        QuadrangleMatcher match;
        Segments hostile = room;
        for (const Segment &bad : {Segment({0, 0}, {0, 0}), Segment({qQNaN(), 0}, {1, 0}),
                                   Segment({0, 0}, {qInf(), 0}), Segment({1e300, 0}, {1e300, 1e300})})
            hostile.push_back(bad);
        const QuadrangleMatch &found = match(hostile, hostile, {0.05, 0.05, 0.02});
        QVERIFY(found.accepted);
        QCOMPARE(found.pairs.size(), room.size());
        QVERIFY(found.pose.translation().norm() < 1e-3);
        QVERIFY(!match(room, room, {qQNaN(), 0, 0}).accepted);
    }
};
