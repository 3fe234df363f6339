#include "RoomScans.h"

#include "tests/support/AllocationCounter.h"
#include "tests/support/Hall.h"
#include "tests/support/RandomRoom.h"
#include "vectorlib/correspondence/CorrespondenceFinder.h"

using namespace vectorlib;

/// The search for corresponding segments finds the pose, thesis 7.4.
class TestCorrespondence : public QObject {
    Q_OBJECT

    static Transformation2D between(const Pose2D &first, const Pose2D &second) {
        return Transformation2D(first).inverse() * Transformation2D(second);
    }
    static double distance(const Transformation2D &a, const Transformation2D &b) {
        return (a.translation() - b.translation()).norm() + std::abs(wrapAngle(a.alpha() - b.alpha()));
    }

private Q_SLOTS:
    void findsThePoseOfRandomRooms() {
        const unsigned seed = newSeed();
        CorrespondenceFinder find;
        int inexact = 0;
        for (unsigned k = 0; k < 200; ++k) {
            const RandomRoom made(seed + k);
            const auto &result = find(seenFrom(made.edges, made.first), seenFrom(made.edges, made.second));
            const QByteArray which = "room " + QByteArray::number(seed + k);
            QVERIFY2(!result.solutions.empty() && result.solutions[0].accepted, which);
            const double off = distance(result.solutions[0].pose, between(made.first, made.second));
            QVERIFY2(off < 0.05, which);
            inexact += off > 1e-6;
        }
        // In one room of some 100,000 a sliver of a wall also fits the next wall, which is nearly in line
        // with it.
        QVERIFY2(inexact <= 2, saying(inexact));
    }

    void expectedTransformationMovesTheSearch() {
        const Pose2D first{-1, 0.2, 0.3}, second{1.4, -0.5, 2.5}; // farther than the permitted set reaches
        CorrespondenceFinder find;
        const Transformation2D truth = between(first, second);
        const auto &result =
            find(seenFrom(room(), first), seenFrom(room(), second), truth * Transformation2D(0.3, -0.4, 0.2));
        QVERIFY(!result.solutions.empty() && result.solutions[0].accepted);
        QVERIFY(distance(result.solutions[0].pose, truth) < 1e-6);
    }

    void otherDirectionsAreOutOfThePermittedSet() {
        CorrespondenceFinder find;
        find.settings.permitted = {0.3, 0.3, 0.1};
        for (const Solution &s : find(seenFrom(room(), {0, 0, 0}), seenFrom(room(), {1, 0, 0})).solutions)
            QVERIFY(!s.accepted);
    }

    void everySymmetryIsASolution() {
        Segments square;
        const std::vector<Point> c = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
        for (std::size_t i = 0; i < 4; ++i)
            square.emplace_back(c[i], c[(i + 1) % 4]);
        CorrespondenceFinder find;
        find.settings.permitted.dalpha = 3.2;
        int accepted = 0;
        for (const Solution &s : find(square, square).solutions)
            accepted += s.accepted;
        QCOMPARE(accepted, 4);
    }

    void numbersAreThoseOfTheCaller() {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const Segments bad = {Segment({nan, 0}, {1, 1}), Segment({1, 1}, {1, 1}),
                              Segment({0, 0}, {0, noHit})};
        Segments fixed = bad, moving = bad;
        for (const Segment &s : room()) {
            fixed.push_back(s);
            moving.push_back(Transformation2D(-0.2, 0.1, 0.1) * s);
        }
        fixed.erase(fixed.begin());
        CorrespondenceFinder find;
        const auto &result = find(fixed, moving);
        QVERIFY(!result.solutions.empty() && result.solutions[0].accepted);
        QCOMPARE(result.solutions[0].pairs.size(), room().size());
        for (const CorrespondencePair &p : result.solutions[0].pairs)
            QVERIFY(p.moving >= 3 && p.fixed == p.moving - 1);
    }

    void searchesAMap() {
        Hall hall(2000);
        const Point middle = hall.middle;
        SegmentMap &map = hall.map;
        const Pose2D pose{middle.x + 0.4, middle.y - 0.3, 0.5};
        const Segments scan = hall.view(pose);
        map.add(Segment({0, std::numeric_limits<double>::quiet_NaN()}, {1, 1}));
        map.add(Segment(middle + Point(-1e6, 100), middle + Point(1e6, 100)));
        CorrespondenceFinder find;
        const auto &result = find(map, scan, Transformation2D(middle.x, middle.y, 0.2));
        QVERIFY(!result.solutions.empty() && result.solutions[0].accepted);
        QVERIFY(distance(result.solutions[0].pose, Transformation2D(pose)) < 1e-6);
        for (const CorrespondencePair &p : result.solutions[0].pairs)
            QVERIFY(map[p.fixed].distance(middle) < 9);
        find(map, scan, Transformation2D(-500, 0, 0));
        QVERIFY(result.solutions.empty());
        QVERIFY(result.outcome == SearchOutcome::NoPotentialPair); // the endless wall alone is looked at
        find.settings.permitted = {1e12, 1e12, 1};                 // the whole map is in reach, at once
        find.settings.maxPairs = 1000;
        find(map, scan, Transformation2D(pose));
        QCOMPARE(describe(result.outcome), describe(SearchOutcome::TooManyPairs));
    }

    void mapSearchDoesNotSlowDownWithTheMap() {
        Hall small(100), large(100000);
        QCOMPARE(small.map.size(), std::size_t(100));
        QCOMPARE(large.map.size(), std::size_t(100000));
        CorrespondenceFinder find;
        std::vector<double> times[2];
        for (int i = 0; i < 101; ++i)
            for (int k = 0; k < 2; ++k) {
                Hall &hall = k == 0 ? small : large;
                const Point at = hall.middle;
                const Segments scan = hall.view({at.x + 0.4, at.y - 0.3, 0.5});
                const auto begin = std::chrono::steady_clock::now();
                const auto &result = find(hall.map, scan, Transformation2D(at.x, at.y, 0.2));
                const auto end = std::chrono::steady_clock::now();
                times[k].push_back(std::chrono::duration<double, std::micro>(end - begin).count());
                QVERIFY(!result.solutions.empty() && result.solutions[0].accepted);
            }
        for (std::vector<double> &t : times)
            std::nth_element(t.begin(), t.begin() + 50, t.end());
        qInfo("100 segments %.1f us, 100,000 segments %.1f us", times[0][50], times[1][50]);
        QVERIFY(times[1][50] < 2 * times[0][50]);
    }

    void givesTheSameAgain() {
        const RandomRoom made(11), other(12);
        CorrespondenceFinder find, fresh;
        const Segments fixed = seenFrom(made.edges, made.first), moving = seenFrom(made.edges, made.second);
        const SearchResult once = find(fixed, moving);
        find(seenFrom(other.edges, other.first), seenFrom(other.edges, other.second));
        find({}, {});
        for (const SearchResult &again : {find(fixed, moving), fresh(fixed, moving)}) {
            QCOMPARE(again.solutions.size(), once.solutions.size());
            for (std::size_t i = 0; i < once.solutions.size(); ++i) {
                QCOMPARE(again.solutions[i].score, once.solutions[i].score);
                QCOMPARE(again.solutions[i].pairs.size(), once.solutions[i].pairs.size());
            }
        }
    }

    void allocatesNothingInSteadyState() {
        const RandomRoom made(7);
        const Segments fixed = seenFrom(made.edges, made.first), moving = seenFrom(made.edges, made.second);
        Hall hall(2000);
        const Point at = hall.middle;
        const Segments scan = hall.view({at.x, at.y, 0.2});
        CorrespondenceFinder find;
        for (const bool inMap : {false, true}) {
            std::size_t before = 0, after = 0, solutions = 0;
            for (int i = 0; i < 5; ++i) {
                before = allocations; // buffers grow in the first rounds
                const auto &result =
                    inMap ? find(hall.map, scan, Transformation2D(at.x, at.y, 0.1)) : find(fixed, moving);
                after = allocations;
                solutions = result.solutions.size();
            }
            QVERIFY(solutions > 0);
            QCOMPARE(after, before);
        }
    }
};
