#include "RandomPairs.h"
#include "RoomScans.h"

#include "vectorlib/observation/SimulatedScanner.h"
#include "vectorlib/relations/PairConsensus.h"
#include "vectorlib/relations/RelationMatcher.h"
#include "vectorlib/relations/RelationScan.h"
#include "vectorlib/relations/RelationScores.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

using namespace vectorlib;
using TypedSegments = std::vector<TypedSegment>;

static constexpr double table51[8][8] = {
    {0, 0, 0, 0.46, 0, 0, 0, 0.03},    {5.61, 0, 0, 0, 0, 0, 0, 0.14},
    {0, 9.75, 0, 0, 0, 0, 0, 0},       {1.28, 0, 0, 0, 0, 0, 0.25, 0.14},
    {0, 0, 0, 0, 1.92, 7.50, 0, 0},    {0, 1.58, 1.17, 1.68, 0.58, 1.50, 2.25, 0.20},
    {0, 0, 0, 0.07, 0, 0, 6.25, 1.31}, {0.11, 0, 0.17, 0, 0, 0, 0.92, 1.87}};

/// The steps of matching without any pose: ends, consistency, relations, scores, pairs.
class TestRelations : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void endsOfAScan() {
        // A corner on the left and a pillar before the wall.
        const Segments world = {Segment({4, -4}, {4, 2}), Segment({4, 2}, {-1, 2}),
                                Segment({2, -0.35}, {2, 0.35}), Segment({2, 0.35}, {2.5, 0.35}),
                                Segment({2.5, -0.35}, {2, -0.35})};
        SimulatedScanner<double> scanner;
        scanner.rays = 361;
        scanner.fieldOfView = pi;
        scanner.sigma = 0;
        std::vector<Vector2D<float>> points;
        for (const Point &p : scanner(world, {}))
            points.emplace_back(p);
        TypedSegmentExtractor extract;
        extract.setScanner(pi, 361);
        const TypedSegments &found = extract(points);
        QCOMPARE(found.size(), std::size_t(4));
        const auto ends = [&](std::size_t i) { return std::pair(found[i].begin.type, found[i].end.type); };
        QVERIFY(ends(0) == std::pair(EndType::Interior, EndType::Interior)); // hidden by the pillar
        QVERIFY(ends(1) == std::pair(EndType::Jump, EndType::Jump));         // the pillar
        QVERIFY(ends(2) == std::pair(EndType::Interior, EndType::Angle));    // on to the corner
        QVERIFY(ends(3).first == EndType::Angle);
        QVERIFY(found[2].joined && !found[1].joined);
        QVERIFY((found[2].segment.end() - Point(4, 2)).norm() < 1e-3);
        QVERIFY((found[1].segment.end() - Point(2, 0.35)).norm() <= found[1].end.slack + 1e-3);
        // What is hidden at the pillar's left end runs away from the sensor: the real side, at 270 degrees,
        // may.
        QVERIFY(found[1].end.bound >= 1.5 * pi && found[1].end.bound < 2 * pi);
    }

    void cornersOfAScan() {
        TypedSegments set = {{Segment({3, -1}, {3, 1}), {}, {}, true, {}},
                             {Segment({3, 1}, {1, 1}), {}, {}, false, {}},
                             {Segment({0.5, 2}, {-0.5, 2}), {}, {}, false, {}},
                             {Segment({-1, 1.5}, {-1, 0}), {}, {}, false, {}}};
        set[2].begin.type = EndType::Jump;
        RelationSettings settings;
        std::vector<Corner> corners;
        CornerFinder find;
        QCOMPARE(find(set, settings, corners), std::size_t(0));
        // 0-1 angle; begin of 2 jump; 1-3 at (-1, 1) is a length from 1; 2-3 at (-1, 2).
        QCOMPARE(corners.size(), std::size_t(4));
        QVERIFY(corners[0].type == CornerType::Angle && (corners[0].point - Point(3, 1)).norm() < 1e-9);
        QVERIFY(corners[1].type == CornerType::JumpBegin && corners[1].second == 2 && corners[1].first == -1);
        QVERIFY(corners[2].type == CornerType::Virtual && (corners[2].point - Point(-1, 1)).norm() < 1e-9);
        QVERIFY(corners[3].type == CornerType::Virtual && (corners[3].point - Point(-1, 2)).norm() < 1e-9);
        settings.maxVirtualEdges = 1;
        QCOMPARE(find(set, settings, corners), std::size_t(1));
        QVERIFY((corners[2].point - Point(-1, 2)).norm() < 1e-9); // the one nearer to its segments
    }

    void lengths_data() {
        const Rows<double, bool, double, bool, bool> row("first", "isFirstComplete", "second",
                                                         "isSecondComplete", "may");
        row("shorter one complete", 1.0, true, 2.0, false, false);
        row("shorter one incomplete", 1.0, false, 2.0, true, true);
        row("both incomplete", 1.0, false, 2.0, false, true);
        row("complete, equal", 1.0, true, 1.0, true, true);
        // As printed Algorithm 2 says no: measured lengths are never equal.
        row("complete, nearly equal", 1.0, true, 1.06, true, true);
        row("complete, different", 1.0, true, 1.12, true, false);
        row("nearly equal, shorter one complete", 1.0, true, 1.06, false, true);
    }

    void lengths() {
        FETCH(double, first, bool, isFirstComplete, double, second, bool, isSecondComplete, bool, may);
        const auto made = [](double length, bool isComplete) {
            TypedSegment s{Segment({0, 1}, {length, 1}), {}, {}, false, {}};
            s.begin.type = EndType::Jump;
            s.end.type = isComplete ? EndType::Angle : EndType::Interior;
            return s;
        };
        const TypedSegment a = made(first, isFirstComplete), b = made(second, isSecondComplete);
        QCOMPARE(lengthsMayMatch(a, b, 0.1), may);
        QCOMPARE(lengthsMayMatch(b, a, 0.1), may);
    }

    void tablesOfConsistency() {
        // Tables 4.1 and 4.2. Lengths and ends are not printed: these give the tables. The first segments of
        // both begin hidden, and 1, 2 of the current scan meet as 2, 3 of the reference do.
        const EndType I = EndType::Interior, J = EndType::Jump, A = EndType::Angle;
        const TypedSegments reference = chain({{3.6, I, A, 90},
                                               {1.5, A, A, 135},
                                               {0.3, A, A, 270},
                                               {3.3, A, I, 0},
                                               {0.6, J, J, 0},
                                               {0.3, I, J, 0},
                                               {4.8, J, A, 270},
                                               {1.8, A, I, 0}});
        const TypedSegments current = chain({{1.2, I, A, 135},
                                             {0.3, A, J, 0},
                                             {1.8, J, A, 270},
                                             {1.8, A, I, 0},
                                             {0.6, J, J, 0},
                                             {0.6, J, J, 0},
                                             {2.7, I, J, 0},
                                             {0.9, I, I, 0}});
        const char *table41[8] = {"00010001", "10000001", "01000000", "10000011",
                                  "00001100", "01111111", "00010011", "10100011"};
        const char *table42[8] = {"10010001", "01000000", "00110001", "10110011",
                                  "00001100", "00001100", "00010011", "10110011"};
        ConsistencyTable toReference, toCurrent;
        toReference.fill(reference, current, {});
        toCurrent.fill(current, current, {});
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j) {
                QVERIFY2(toReference(i, j) == (table41[i][j] == '1'), saying("4.1: %1, %2", i + 1, j + 1));
                QVERIFY2(toCurrent(i, j) == (table42[i][j] == '1'), saying("4.2: %1, %2", i + 1, j + 1));
                QCOMPARE(toCurrent(i, j), toCurrent(j, i));
            }
    }

    void relativeAngles_data() {
        // Figure 4.4, with the second segment along x.
        const Rows<double, double, double> row("x", "y", "angle");
        row("4", 1.0, 0.0, 0.0);
        row("3", 0.0, 1.0, 90.0);
        row("7", -1.0, 0.0, 180.0);
        row("1", 0.0, -1.0, 270.0);
    }

    void relativeAngles() {
        FETCH(double, x, double, y, double, angle);
        const Segment along({0, 0}, {1, 0}), other({5, 3}, Point(5, 3) + Point(x, y));
        QVERIFY(std::abs(relativeAngle(along, other) * 180 / pi - angle) < 1e-9);
    }

    void parallelSegments_data() {
        const Rows<double, double, int, int, int, double> row(
            "from", "to", "firstEnd", "secondBegin", "kind",
            "along"); // to: of the second, along the first, which runs from 0 to 2; 1 m across
        const int edge = int(EndType::Jump), open = int(EndType::Interior);
        const int overlap = int(OverlapKind::Overlap), may = int(OverlapKind::MayOverlap),
                  none = int(OverlapKind::NoOverlap);
        row("overlap", 1.5, 3.0, edge, edge, overlap, 0.5);
        row("overlap, the other way", 3.0, 1.5, edge, edge, overlap, 0.5);
        row("apart", 2.5, 3.5, edge, edge, none, 0.5);
        row("apart before it", -1.5, -0.5, edge, edge, none, 0.5);
        row("may, the first goes on", 2.5, 3.5, open, edge, may, 0.0);
        row("may, the second goes on", 2.5, 3.5, edge, open, may, 0.0);
    }

    void parallelSegments() {
        FETCH(double, from, double, to, int, firstEnd, int, secondBegin, int, kind, double, along);
        TypedSegment a{Segment({0, 0}, {2, 0}), {}, {}, false, {}},
            b{Segment({from, 1}, {to, 1}), {}, {}, false, {}};
        a.begin.type = b.end.type = EndType::Jump;
        a.end.type = EndType(firstEnd);
        b.begin.type = EndType(secondBegin);
        ParallelRelation relation;
        QVERIFY(parallelRelation(a, b, 0.08, relation));
        QCOMPARE(int(relation.kind), kind);
        QVERIFY(std::abs(double(relation.along) - along) < 1e-6);
        QVERIFY(std::abs(double(relation.across) - 1) < 1e-6);
        QVERIFY(!parallelRelation(a, {Segment({0, 1}, {2, 1.5}), {}, {}, false, {}}, 0.08, relation));
    }

    void rangeQueriesFindWhatADoubleLoopFinds() {
        RelationSettings settings;
        const int turn = turnPart(settings.angleWindow);
        const auto window = static_cast<float>(settings.distanceWindow);
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            std::mt19937_64 random(seed);
            RelationSet a, b;
            TypedSegments ours = randomSegments(random, 12), theirs = randomSegments(random, 12);
            if (seed % 2 == 0) // as far apart as no bin is; some distances as before
                for (TypedSegments *set : {&ours, &theirs})
                    for (std::size_t i = 6; i < set->size(); ++i)
                        (*set)[i].segment = Transformation2D(40, -30, 0) * (*set)[i].segment;
            a.build(ours, settings);
            b.build(theirs, settings);
            const auto check = [&](const auto &these, const auto &those, auto equal) {
                for (const auto &r : these) {
                    std::vector<std::pair<int, int>> expected, found;
                    for (const auto &other : those)
                        if (equal(r, other))
                            expected.emplace_back(other.first, other.second);
                    b.like(r, [&](const auto &other) { found.emplace_back(other.first, other.second); });
                    std::sort(expected.begin(), expected.end());
                    std::sort(found.begin(), found.end());
                    QVERIFY2(found == expected, saying("seed %1", seed));
                }
            };
            check(a.angles(), b.angles(), [&](const AngleRelation &r, const AngleRelation &o) {
                return isWithin(r.angle, o.angle, turn);
            });
            const auto parameters = [&](const auto &r, const auto &o) {
                return parametersMatch(r, o, window, turn);
            };
            check(a.parallels(), b.parallels(), parameters);
            check(a.cornerRelations(), b.cornerRelations(), parameters);
        }
    }

    void scoresAreThoseOfTheDefinition() {
        RelationSettings settings;
        settings.leastEdgeDistance = 1000; // corners are left out by a distance that none keeps
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            std::mt19937_64 random(seed);
            const TypedSegments r = randomSegments(random, 9), c = randomSegments(random, 7);
            RelationSet ofR, ofC;
            ofR.build(r, settings);
            ofC.build(c, settings);
            RelationScores scores;
            MatchingTable table;
            scores(r, ofR, c, ofC, settings, table);
            const std::vector<double> expected = scoresByDefinition(r, ofR, c, ofC, settings);
            for (std::size_t i = 0; i < r.size(); ++i)
                for (std::size_t j = 0; j < c.size(); ++j)
                    QVERIFY2(std::abs(table.merged(int(i), int(j)) - expected[i * c.size() + j]) < 1e-6,
                             saying("seed %1: %2, %3", seed, i, j));
        }
    }

    void publishedMatchingTable_data() {
        const Rows<bool, double> row("sameOrder", "threshold");
        row("Algorithm 7", false, 0.0);
        row("Algorithm 10", true, 0.0);
        row("a tenth of the maximum", true, 0.975);
    }

    void publishedMatchingTable() {
        FETCH(bool, sameOrder, double, threshold);
        MatchingTable table = publishedTable();
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j)
                QVERIFY(std::abs(table.merged(i, j) - table51[i][j]) < 1e-9);
        PairSearch search;
        search.sameOrder = sameOrder;
        search.threshold = threshold;
        const int partner[8] = {-1, 0, 1, -1, 5, -1, 6, -1}; // of the reference segments
        const auto &pairs = search(
            table, [&](int row, int column) { return (partner[row] == column ? 51 : 51 + 90) * pi / 180; });
        QCOMPARE(pairs.size(), std::size_t(4));
        const CorrespondencePair order[] = {{2, 1}, {4, 5}, {6, 6}, {1, 0}};
        for (int i = 0; i < 4; ++i)
            QVERIFY(pairs[std::size_t(i)].fixed == order[i].fixed &&
                    pairs[std::size_t(i)].moving == order[i].moving);
        const double table52[8] = {0, 4.82, 8.08, 0, 7.12, 0, 5.33, 0};
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j)
                if (partner[i] == j)
                    QVERIFY(std::abs(table.merged(i, j) - table52[i]) < 1e-9);
                else if (threshold == 0)
                    QCOMPARE(table.merged(i, j), 0.0); // exactly
    }

    void aMatchMakesOthersInvalid_data() {
        const Rows<bool> row("sameOrder");
        row("row and column", false); // Algorithm 7
        row("order", true);           // both calls of Algorithm 10
    }

    void aMatchMakesOthersInvalid() {
        QFETCH(bool, sameOrder);
        MatchingTable table;
        table.reset(5, 4);
        for (std::size_t cell = 0; cell < 20; ++cell)
            table.add(1, &cell, 1);
        if (sameOrder)
            table.keepInOrder(2, 1);
        else
            table.keepOnly(2, 1);
        for (int i = 0; i < 5; ++i)
            for (int j = 0; j < 4; ++j) {
                const bool isItself = i == 2 && j == 1;
                const bool isRival = sameOrder ? (i <= 2 && j >= 1) || (i >= 2 && j <= 1) : i == 2 || j == 1;
                QCOMPARE(table.merged(i, j), isItself || !isRival ? 1.0 : 0.0);
            }
    }

    void rotationIsACircularMean() {
        // Algorithm 8 as printed divides by the number of pairs, not by the weights, and 359 and 1 degree
        // would be half a turn.
        const auto turned = [](double degrees, double length) {
            return TypedSegment{
                Transformation2D(0, 0, degrees * pi / 180) * Segment({0, 0}, {length, 0}), {}, {}, false, {}};
        };
        const TypedSegments current = {turned(0, 2), turned(90, 2), turned(200, 3)};
        const TypedSegments same = {turned(10, 2), turned(100, 2), turned(210, 3)};
        const std::vector<CorrespondencePair> pairs = {{0, 0}, {1, 1}, {2, 2}};
        QVERIFY(std::abs(rotationalDifference(pairs, same, current) - 10 * pi / 180) < 1e-9);
        const TypedSegments around = {turned(179, 2), turned(90 - 179, 2)};
        QVERIFY(std::abs(std::abs(rotationalDifference({{0, 0}, {1, 1}}, around, current)) - pi) < 1e-9);
        // Nine times the weight of a segment of a third of the length.
        const TypedSegments uneven = {turned(8, 3), turned(98 - 10, 1)};
        const double mean = rotationalDifference({{0, 0}, {1, 1}}, uneven, {turned(0, 3), turned(90, 1)});
        QVERIFY(std::abs(mean * 180 / pi - (9 * 8.0 - 2) / 10) < 0.02);
    }

    void translationIsDividedByItsWeights() {
        const Transformation2D truth(1.06, 2.47, 51 * pi / 180);
        TypedSegments reference, current;
        for (const Segment &s : room()) {
            reference.push_back({truth * s, {}, {}, false, {}});
            current.push_back({s, {}, {}, false, {}});
        }
        std::vector<CorrespondencePair> pairs;
        for (int i = 0; i < 6; ++i)
            pairs.push_back({i, i});
        Transformation2D pose;
        QVERIFY(poseDifference(pairs, reference, current, 0.3, pose));
        QVERIFY(difference(pose, truth) < 1e-9);
        QVERIFY(!poseDifference({{0, 0}, {2, 2}, {0, 0}}, {reference[0], reference[4], reference[4]},
                                {current[0], current[4], current[4]}, 0.3, pose)); // no edge
    }

private:
    static TypedSegments randomSegments(std::mt19937_64 &random, int count) {
        std::uniform_real_distribution<double> place(-4, 4), noise(-0.03, 0.03);
        TypedSegments set;
        for (int i = 0; i < count; ++i) { // many alike, as in a building
            const double turn = double(random() % 8) * pi / 4 + noise(random);
            const Point p(place(random), place(random)), d(std::cos(turn), std::sin(turn));
            TypedSegment s{
                Segment(p, p + d * (0.5 * double(1 + random() % 4))), {}, {}, random() % 3 == 0, {}};
            s.begin.type = EndType(random() % 3);
            s.end.type = EndType(random() % 3);
            set.push_back(s);
        }
        return set;
    }
    struct Made {
        double length;
        EndType begin, end;
        double angle; // to the next, degrees; where the end is an angle edge
    };
    static TypedSegments chain(const std::vector<Made> &made) {
        TypedSegments set;
        double direction = 0;
        for (const Made &m : made) {
            TypedSegment s{Segment({0, 0}, Point(std::cos(direction), std::sin(direction)) * m.length),
                           {m.begin, 0, 2 * pi},
                           {m.end, 0, 2 * pi},
                           m.end == EndType::Angle,
                           {}};
            set.push_back(s);
            direction += m.angle * pi / 180;
        }
        return set;
    }

    // Algorithms 3 and 4 as loops over everything, with erratum 12, for the relations of two segments and for
    // lengths.
    static std::vector<double> scoresByDefinition(const TypedSegments &r, const RelationSet &ofR,
                                                  const TypedSegments &c, const RelationSet &ofC,
                                                  const RelationSettings &settings) {
        const int turn = turnPart(settings.angleWindow);
        const auto window = static_cast<float>(settings.distanceWindow);
        ConsistencyTable rc, cc;
        rc.fill(r, c, settings);
        cc.fill(c, c, settings);
        std::vector<double> scores(r.size() * c.size(), 0);
        const auto enter = [&](const auto &reference, const auto &current, auto equal) {
            for (const auto &g : current) {
                const auto matches = [&](const ConsistencyTable &table, const auto &o) {
                    return table(int(o.first), int(g.first)) && table(int(o.second), int(g.second)) &&
                           equal(g, o);
                };
                const auto inC = std::count_if(current.begin(), current.end(),
                                               [&](const auto &o) { return matches(cc, o); });
                const auto inR = std::count_if(reference.begin(), reference.end(),
                                               [&](const auto &o) { return matches(rc, o); });
                for (const auto &o : reference)
                    if (matches(rc, o))
                        for (const auto &[i, j] :
                             {std::pair(o.first, g.first), std::pair(o.second, g.second)})
                            scores[std::size_t(i) * c.size() + std::size_t(j)] += 1.0 / double(inC * inR);
            }
        };
        enter(ofR.angles(), ofC.angles(),
              [&](const auto &g, const auto &o) { return isWithin(g.angle, o.angle, turn); });
        enter(ofR.parallels(), ofC.parallels(),
              [&](const auto &g, const auto &o) { return parametersMatch(g, o, window, turn); });
        for (std::size_t j = 0; j < c.size(); ++j) {
            int inC = 0, inR = 0;
            for (std::size_t i = 0; i < c.size(); ++i)
                inC += cc(i, j);
            for (std::size_t i = 0; i < r.size(); ++i)
                inR += rc(i, j);
            for (std::size_t i = 0; i < r.size(); ++i)
                if (rc(i, j))
                    scores[i * c.size() + j] += 1.0 / (inC * inR);
        }
        return scores;
    }

    static MatchingTable publishedTable() {
        // The lists behind the sums are not printed. What the true pairs lose between tables 5.1 and 5.2 they
        // share with pairs that are found wrong; the rest stands alone.
        struct Shared {
            double score;
            int row, column, wrongRow, wrongColumn;
        };
        const Shared shared[] = {
            {0.79, 2, 1, 6, 2}, {1.67, 3, 2, 6, 7}, {0.38, 5, 6, 6, 7}, {0.92, 7, 7, 4, 1}};
        MatchingTable table;
        table.reset(8, 8);
        double rest[8][8];
        std::copy(&table51[0][0], &table51[0][0] + 64, &rest[0][0]);
        for (const Shared &s : shared) {
            const std::size_t cells[2] = {table.cell(s.row - 1, s.column - 1),
                                          table.cell(s.wrongRow - 1, s.wrongColumn - 1)};
            table.add(s.score, cells, 2);
            rest[s.row - 1][s.column - 1] -= s.score;
            rest[s.wrongRow - 1][s.wrongColumn - 1] -= s.score;
        }
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j)
                if (const std::size_t cell = table.cell(i, j); rest[i][j] > 1e-9)
                    table.add(rest[i][j], &cell, 1);
        return table;
    }
};
