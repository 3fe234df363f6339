#include "RandomPairs.h"
#include "RoomScans.h"

#include "tests/support/AllocationCounter.h"
#include "tests/support/RandomRoom.h"
#include "vectorlib/observation/SimulatedScanner.h"
#include "vectorlib/relations/LocalMap.h"
#include "vectorlib/relations/RelationMatcher.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

using namespace vectorlib;
using TypedSegments = std::vector<TypedSegment>;

/// Matching without any pose: the whole of it. The steps are in TestRelations.
class TestRelationMatcher : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void findsThePoseOfThePublishedExample() {
        // Figure 5.3: (106 cm, 247 cm, 51 degrees), current 1, 2, 6, 7 on reference 2, 3, 5, 7. What the
        // others look like is not printed: these stand elsewhere in either scan.
        const Transformation2D truth(1.06, 2.47, 51 * pi / 180);
        const Segment common[4] = {Segment({4.0, -0.8}, {4.0, 1.2}), Segment({4.0, 1.2}, {2.9, 1.2}),
                                   Segment({1.6, 4.4}, {0.2, 4.9}), Segment({-1.3, 4.0}, {-2.9, 3.3})};
        TypedSegments reference = plain(
            {Segment({2.2, -2.4}, {3.1, -2.1}), common[0], common[1], Segment({2.6, 3.1}, {1.9, 3.5}),
             common[2], Segment({0.0, 3.6}, {-0.5, 3.7}), common[3], Segment({-3.4, 1.9}, {-3.0, 0.7})});
        const Transformation2D back = truth.inverse();
        TypedSegments current =
            plain({back * common[0], back * common[1], Segment({0.9, -3.3}, {1.9, -3.6}),
                   Segment({2.7, -2.9}, {3.1, -2.5}), Segment({1.1, -1.0}, {1.3, -0.4}), back * common[2],
                   back * common[3], Segment({-4.0, 1.1}, {-4.3, 0.2})});
        RelationMatcher match;
        match.settings.seenThroughShare = 0.25; // for the made-up ones
        const RelationMatch &found = match(reference, current);
        QCOMPARE(describe(found.outcome), describe(RelationOutcome::Matched));
        std::vector<std::pair<int, int>> pairs;
        for (const CorrespondencePair &p : found.pairs)
            pairs.emplace_back(p.moving + 1, p.fixed + 1);
        std::sort(pairs.begin(), pairs.end());
        QVERIFY((pairs == std::vector<std::pair<int, int>>{{1, 2}, {2, 3}, {6, 5}, {7, 7}}));
        for (const Transformation2D &pose : {found.pose, found.byEdges}) {
            QVERIFY((pose.translation() - truth.translation()).norm() < 1e-6);
            QVERIFY(std::abs(wrapAngle(pose.alpha() - truth.alpha())) < 1e-6);
        }
    }

    void saysWhy_data() {
        const Rows<int, int> row("which", "outcome");
        const RelationOutcome few = RelationOutcome::TooFewReference, less = RelationOutcome::TooFewCurrent;
        const std::tuple<const char *, RelationOutcome> rows[] = {
            {"nothing in the reference", few},
            {"nothing at all", few},
            {"one segment", less},
            {"only NaN", less},
            {"no length", less},
            {"too far away", less},
            {"nothing like it", RelationOutcome::NoCommonRelation},
            {"a corridor", RelationOutcome::OneDirection},
            {"NaN window", RelationOutcome::BadSettings},
            {"no window", RelationOutcome::BadSettings},
            {"NaN threshold", RelationOutcome::BadSettings},
            {"too many wanted", RelationOutcome::BadSettings},
            {"all may be seen through", RelationOutcome::BadSettings},
        };
        int i = 0;
        for (const auto &[name, outcome] : rows)
            row(name, i++, static_cast<int>(outcome));
    }

    void saysWhy() {
        FETCH(int, which, int, outcome);
        RelationMatcher match;
        TypedSegments reference = complete(room()), current = reference;
        spoil(which, reference, current);
        spoil(which, match.settings);
        const RelationMatch &found = match(reference, current);
        QCOMPARE(describe(found.outcome), describe(RelationOutcome(outcome)));
        QVERIFY(!found.isMatched() && found.pairs.empty());
        QVERIFY(difference(found.pose, Transformation2D()) == 0);
    }

    void symmetricRoomsAreAmbiguousOnlyWhereTheyAre_data() {
        const Rows<QVector<QPointF>, bool> row("corners", "ambiguous");
        row("square", {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}, true);
        row("rectangle", {{-3, -2}, {3, -2}, {3, 2}, {-3, 2}}, true);
        // A mirror image has its angles in the other order, and the sensor tells left from right.
        row("mirror symmetric", {{-3, -2}, {3, -2}, {2, 2.5}, {-2, 2.5}}, false);
        row("notched", {{-3, -2}, {3, -2}, {3, 1}, {2, 1}, {2, 2}, {-3, 2}}, false);
    }

    void symmetricRoomsAreAmbiguousOnlyWhereTheyAre() {
        FETCH(QVector<QPointF>, corners, bool, ambiguous);
        Segments walls;
        for (int i = 0; i < corners.size(); ++i) {
            const QPointF a = corners[i], b = corners[(i + 1) % corners.size()];
            walls.emplace_back(Point(a.x(), a.y()), Point(b.x(), b.y()));
        }
        const Transformation2D motion(0.4, -0.3, 0.2);
        RelationMatcher match;
        const RelationMatch &found = match(complete(walls), complete(moved(motion.inverse(), walls)));
        QCOMPARE(describe(found.outcome),
                 describe(ambiguous ? RelationOutcome::Ambiguous : RelationOutcome::Matched));
        if (!ambiguous)
            QVERIFY(difference(found.pose, motion) < 1e-6);
    }

    void hugeSetsAreLimited() {
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> anywhere(-500, 500), small(-0.5, 0.5);
        TypedSegments many = plain(room());
        while (many.size() < 500000) {
            const Point p(anywhere(random), anywhere(random));
            many.push_back({Segment(p, p + Point(small(random), small(random))), {}, {}, false, {}});
        }
        RelationMatcher match;
        const RelationMatch &found = match(many, many);
        QCOMPARE(found.leftOut, 2 * (many.size() - match.settings.maxSegments));
        QVERIFY(found.scores <= match.settings.maxScores);
        QVERIFY(found.isMatched());
        QVERIFY(difference(found.pose, Transformation2D()) < 1e-6);
    }

    void manyEqualSegmentsAreLimited() {
        // A fence: all relations are alike.
        TypedSegments fence;
        for (int i = 0; i < 200; ++i) {
            TypedSegment s{Segment({0.5 * i, 3}, {0.5 * i - 0.3, 3}), {}, {}, false, {}};
            s.begin.type = s.end.type = EndType::Jump;
            fence.push_back(s);
        }
        RelationMatcher match;
        const RelationMatch &found = match(fence, fence);
        QVERIFY(found.isCut && found.scores <= match.settings.maxScores);
        QVERIFY(!found.isMatched());
    }

    void farCornersAreLimited() {
        // Walls around the sensor, no two corners nearer than 30 m; some 10,000 relations of corners in each
        // scan.
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> range(800, 1600), tilt(-0.6, 0.6), length(31, 40);
        TypedSegments far;
        for (int i = 0; i < 64; ++i) {
            const double angle = 2 * pi * i / 64, along = angle + pi / 2 + tilt(random);
            const Point p = Point(std::cos(angle), std::sin(angle)) * range(random);
            TypedSegment s{
                Segment(p, p + Point(std::cos(along), std::sin(along)) * length(random)), {}, {}, false, {}};
            s.begin.type = s.end.type = EndType::Jump;
            far.push_back(s);
        }
        RelationMatcher match;
        const RelationMatch &found = match(far, far);
        QVERIFY2(found.compared < 5000000, saying(found.compared));
        QVERIFY2(!found.isCut && found.isMatched(), describe(found.outcome));
        match.settings.maxCompared = 50000;
        match(far, far);
        // The last relation of the current scan is compared to its end.
        QVERIFY2(found.isCut && found.compared < 50000 + 2 * 12000, saying(found.compared));
    }

    void everyBoundOnScoresHolds() {
        const TypedSegments segments = plain(room()); // incomplete ones: every length is like many
        RelationMatcher match;
        for (const std::size_t most : {0, 1, 7, 30, 100}) {
            match.settings.maxScores = most;
            const RelationMatch &found = match(segments, segments);
            QVERIFY2(found.isCut && found.scores <= most, saying(found.scores));
        }
    }

    void allocatesNothingInSteadyState() {
        const RandomRoom made(7);
        const TypedSegments reference = scanned(made, made.first, 1), current = scanned(made, made.second, 2);
        RelationMatcher match;
        for (int i = 0; i < 3; ++i) {
            match(reference, current);
            match.next(current);
            match.next(reference);
        }
        const std::size_t before = allocations;
        match(reference, current);
        const std::size_t more = allocations - before;
        QCOMPARE(more, std::size_t(0));
    }

    void nextGivesTheSameAsBoth() {
        const RandomRoom made(11);
        const TypedSegments first = scanned(made, made.first, 1), second = scanned(made, made.second, 2);
        RelationMatcher match, other;
        match(second, first);
        const RelationMatch &found = match.next(second), &same = other(first, second);
        QCOMPARE(found.outcome, same.outcome);
        QVERIFY(difference(found.pose, same.pose) == 0);
    }

    void randomWorldsGiveTheTrueMotion_data() {
        QTest::addColumn<quint64>("seed");
        for (quint64 seed = 100; seed < 140; ++seed)
            QTest::addRow("seed %llu", seed) << seed;
    }

    void randomWorldsGiveTheTrueMotion() {
        QFETCH(quint64, seed);
        RandomRoom made(seed);
        made.second.theta = 0.77 * double(seed); // any heading at all
        const Transformation2D truth = motionOf(made);
        RelationMatcher match;
        const RelationMatch &found =
            match(scanned(made, made.first, 2 * seed), scanned(made, made.second, 2 * seed + 1));
        QVERIFY2(found.isMatched(), describe(found.outcome));
        QVERIFY2((found.pose.translation() - truth.translation()).norm() < 0.03,
                 saying((found.pose.translation() - truth.translation()).norm()));
        QVERIFY(std::abs(wrapAngle(found.pose.alpha() - truth.alpha())) < 0.01);
    }

    void halfTurnsGiveTheTrueMotion() {
        // Half a turn at 1 degree, seeds 200 to 299: a few see too little to be sure, none may be wrong.
        RelationMatcher match;
        int matched = 0;
        for (std::uint64_t seed = 200; seed < 300; ++seed) {
            const RandomRoom made(seed);
            const Transformation2D truth = motionOf(made);
            const RelationMatch &found = match(scanned(made, made.first, 2 * seed, pi, 181),
                                               scanned(made, made.second, 2 * seed + 1, pi, 181));
            if (!found.isMatched())
                continue;
            ++matched;
            QVERIFY2((found.pose.translation() - truth.translation()).norm() < 0.05 &&
                         std::abs(wrapAngle(found.pose.alpha() - truth.alpha())) < 0.02,
                     saying("seed %1", seed));
        }
        QVERIFY2(matched >= 97, saying(matched));
    }

    void strangeSegmentsNeverCrash() {
        std::mt19937_64 random(99);
        const double strange[] = {0,   -0.0,  1,     -1,    1e-300, 1e5,
                                  1e6, -1e12, 1e300, noHit, -noHit, std::numeric_limits<double>::quiet_NaN(),
                                  0.5, 2,     3,     7};
        const auto any = [&] { return strange[random() % 16]; };
        RelationMatcher match;
        for (int round = 0; round < 2000; ++round) {
            TypedSegments sets[2];
            for (TypedSegments &set : sets)
                for (std::size_t i = random() % 12; i > 0; --i) {
                    TypedSegment s{Segment({any(), any()}, {any(), any()}), {}, {}, random() % 2 == 0, {}};
                    s.begin = {EndType(random() % 3), any(), any()};
                    s.end = {EndType(random() % 3), any(), any()};
                    set.push_back(s);
                }
            const RelationMatch &found = match(sets[0], sets[1]);
            QVERIFY2(found.pose.isFinite(), saying("round %1 of seed 99", round));
            for (const CorrespondencePair &p : found.pairs)
                QVERIFY(std::size_t(p.fixed) < sets[0].size() && std::size_t(p.moving) < sets[1].size());
        }
    }

    void mapGrowsByMerging() {
        LocalMap map;
        const TypedSegments first = plain({Segment({3, -1}, {3, 1}), Segment({3, 1}, {0, 1})});
        map.update({}, first, {});
        QCOMPARE(map.map().size(), std::size_t(2));
        // The first is matched, the second overlaps on its line, the third is new.
        const Transformation2D motion(0.5, 0, 0);
        const TypedSegments second =
            plain(moved(motion.inverse(),
                        {Segment({3, 0}, {3, 1.5}), Segment({2, 1}, {-2, 1}), Segment({-2, 1}, {-2, -1})}));
        map.update({{0, 0}}, second, motion);
        QCOMPARE(map.map().size(), std::size_t(3));
        double length = 0;
        map.map().forEach([&](const MapEdge &e) { length += e.segment.length(); });
        QVERIFY(std::abs(length - (2.5 + 5 + 2)) < 1e-6);
        // Nothing matched: the lines alone tell.
        map.update({}, second, motion);
        QCOMPARE(map.map().size(), std::size_t(3));
    }

private:
    static Transformation2D motionOf(const RandomRoom &room) {
        return Transformation2D(room.first).inverse() * Transformation2D(room.second);
    }
    static TypedSegments plain(const Segments &segments) {
        TypedSegments typed;
        for (const Segment &s : segments)
            typed.push_back({s, {}, {}, false, {}});
        return typed;
    }
    /// Complete segments that touch are joined by an angle edge.
    static TypedSegments complete(const Segments &segments) {
        TypedSegments typed = plain(segments);
        for (std::size_t i = 0; i < typed.size(); ++i) {
            typed[i].begin.type = typed[i].end.type = EndType::Angle;
            typed[i].joined =
                i + 1 < typed.size() && (segments[i].end() - segments[i + 1].begin()).norm() < 1e-9;
        }
        return typed;
    }
    /// Makes the sets, or the settings, those of a row of saysWhy.
    static void spoil(int which, TypedSegments &reference, TypedSegments &current) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const TypedSegments spoiled[] = {
            {},
            {},
            {current[0]},
            plain({Segment({nan, 0}, {1, 1}), Segment({0, 1}, {nan, nan}), Segment({0, 1}, {noHit, 1})}),
            plain({Segment({1, 1}, {1, 1}), Segment({2, 1}, {2, 1})}),
            plain({Segment({1e300, 1}, {1e300, 2e300}), Segment({1e9, 1}, {2e9, 1})}),
            complete({Segment({9, -4}, {9, 4}), Segment({5, 8}, {4, 20})}),
            plain({Segment({-3, -1}, {3, -1}), Segment({3, 1}, {-3, 1})})};
        if (which != 0 && which < 8)
            current = spoiled[which];
        if (which < 2)
            reference.clear();
        if (which == 6)
            reference = complete({Segment({3, -1}, {3, 1}), Segment({3, 1}, {-1, 1})});
        if (which == 7)
            reference = current;
    }

    static void spoil(int which, RelationSettings &settings) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        if (which == 8)
            settings.angleWindow = nan;
        if (which == 9)
            settings.distanceWindow = 0;
        if (which == 10)
            settings.threshold = nan;
        if (which == 11)
            settings.maxSegments = 100000;
        if (which == 12)
            settings.seenThroughShare = 1; // matched with nothing that speaks for it
    }

    static TypedSegments scanned(const RandomRoom &room, const Pose2D &pose, std::uint64_t seed,
                                 double fieldOfView = 2 * pi, int rays = 720) {
        SimulatedScanner<double> scanner(seed);
        scanner.fieldOfView = fieldOfView;
        scanner.rays = rays;
        std::vector<Vector2D<float>> points;
        for (const Point &p : scanner(room.edges, pose))
            points.emplace_back(p);
        TypedSegmentExtractor extract;
        extract.setScanner(fieldOfView, static_cast<std::size_t>(rays));
        return extract(points);
    }
};
