#include "vectorlib/correspondence/CorrespondenceFinder.h"

#include "tests/support/Hall.h"
#include "tests/support/RandomRoom.h"

#include <QtTest>

#include <chrono>
#include <cstdlib>
#include <new>

// Every allocation of the program is counted.
static std::size_t allocations = 0;
void *operator new(std::size_t size) {
    ++allocations;
    if (void *memory = std::malloc(size))
        return memory;
    throw std::bad_alloc();
}
void operator delete(void *memory) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept {
    std::free(memory);
}

using namespace vectorlib;

namespace {

using Segment = LineSegment2D<double>;
using Segments = std::vector<Segment>;
using Point = Vector2D<double>;

/// What a sensor sees of a world, without noise.
Segments seenFrom(const Segments &world, const Pose2D &pose) {
    Observer<double> observe;
    Segments view;
    for (const auto &part : observe(world, pose))
        view.push_back(part.segment);
    return view;
}
Transformation2D between(const Pose2D &first, const Pose2D &second) {
    return Transformation2D(first).inverse() * Transformation2D(second);
}
double distance(const Transformation2D &a, const Transformation2D &b) {
    return (a.translation() - b.translation()).norm() + std::abs(wrapAngle(a.alpha() - b.alpha()));
}
/// A room of 6 m x 4 m about the origin with a notch, so that it looks different from everywhere.
Segments room() {
    const std::vector<Point> corners = {{-3, -2}, {3, -2}, {3, 1}, {2, 1}, {2, 2}, {-3, 2}};
    Segments edges;
    for (std::size_t i = 0; i < corners.size(); ++i)
        edges.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    return edges;
}
Segments moved(const Transformation2D &t, const Segments &segments) {
    Segments result;
    for (const Segment &s : segments)
        result.push_back(t * s);
    return result;
}
std::vector<PotentialPair> pairsOf(const Segments &fixed, const Segments &moving) {
    std::vector<PotentialPair> pairs;
    for (std::size_t m = 0; m < moving.size(); ++m)
        for (std::size_t f = 0; f < fixed.size(); ++f)
            if (mayCorrespond(fixed[f], moving[m], PermittedError()))
                pairs.emplace_back(CorrespondencePair{int(f), int(m)}, fixed[f], moving[m], Stiffness());
    return pairs;
}

} // namespace

/// The search for corresponding segments, thesis 7.4.
class TestCorrespondence : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void pairsOfOneShiftAreOneBundle();
    void facingWallsAreOneBundle();
    void badPairDoesNotHideInALargeBundle();
    void bucketsAreDirections();
    void combinationsAreThoseOfExhaustiveSearch();
    void boundOnCombinationsIsReported();
    void findsThePoseOfRandomRooms();
    void expectedTransformationMovesTheSearch();
    void otherDirectionsAreOutOfThePermittedSet();
    void everySymmetryIsASolution();
    void viewThatSeesNothingIsNoEvidence();
    void numbersAreThoseOfTheCaller();
    void searchesAMap();
    void mapSearchDoesNotSlowDownWithTheMap();
    void saysWhyThereIsNothing_data();
    void saysWhyThereIsNothing();
    void tellsTheFaultOfASolution();
    void thresholdsOfZeroAcceptNothing_data();
    void thresholdsOfZeroAcceptNothing();
    void givesTheSameAgain();
    void allocatesNothingInSteadyState();
};

void TestCorrespondence::pairsOfOneShiftAreOneBundle() {
    // Two parts of one wall, and a wall 30 cm behind: 2 x 2 pairs without shift, 2 with 30 cm, 2 with -30 cm.
    const Segments scan = {Segment({2, -1}, {2, 0}), Segment({2, 0.5}, {2, 1.5}),
                           Segment({2.3, -3}, {2.3, -2})};
    auto pairs = pairsOf(scan, scan);
    CollinearBundles bundle;
    const auto &bundles = bundle(pairs);
    QCOMPARE(bundles.size(), std::size_t(3));
    std::map<double, int> counts;
    for (const Bundle &b : bundles)
        for (int i = b.first; i >= 0; i = bundle.next(i))
            ++counts[std::round(b.shift * 10)];
    QCOMPARE(counts.size(), std::size_t(3));
    QVERIFY(counts[0] >= 3 && counts[3] >= 1 && counts[-3] >= 1);
    for (const Bundle &b : bundles)
        QVERIFY(b.sums.reliability() < 1e-6);
}

void TestCorrespondence::facingWallsAreOneBundle() {
    const Segments scan = {Segment({2, -1}, {2, 1}), Segment({-2, 1}, {-2, -1})};
    auto pairs = pairsOf(moved({0.5, 0.2, 0}, scan), scan);
    CollinearBundles bundle;
    QCOMPARE(bundle(pairs).size(), std::size_t(1));
    QCOMPARE(bundle(pairs)[0].sums.pairs(), 2);
}

void TestCorrespondence::badPairDoesNotHideInALargeBundle() {
    Segments scan = {Segment({2, -4}, {2, 4})};
    std::vector<PotentialPair> pairs = pairsOf(scan, scan);
    pairs.emplace_back(CorrespondencePair{1, 1}, Segment({3.12, 0}, {3.12, 0.3}), Segment({3, 0}, {3, 0.3}),
                       Stiffness());
    CollinearBundles bundle;
    QCOMPARE(bundle(pairs).size(), std::size_t(2)); // though 0.3 m of 12 cm beside 8 m is little on average
}

void TestCorrespondence::bucketsAreDirections() {
    auto pairs = pairsOf(room(), room());
    CollinearBundles bundle;
    BundleBuckets buckets;
    const auto &bundles = bundle(pairs);
    buckets(bundles);
    QCOMPARE(buckets.size(), std::size_t(2));
    for (std::size_t b = 0; b < buckets.size(); ++b)
        for (std::size_t i = buckets.begin(b) + 1; i < buckets.begin(b + 1); ++i) {
            QVERIFY(std::abs(buckets.bundle(i).normal.cross(buckets.bundle(i - 1).normal)) < 0.1);
            QVERIFY(buckets.bundle(i).length <= buckets.bundle(i - 1).length);
        }
}

void TestCorrespondence::combinationsAreThoseOfExhaustiveSearch() {
    const unsigned seed = std::random_device()();
    qInfo("seed %u", seed);
    for (unsigned k = 0; k < 20; ++k) {
        const RandomRoom made(seed + k);
        auto pairs = pairsOf(seenFrom(made.edges, made.first), seenFrom(made.edges, made.second));
        CollinearBundles bundle;
        BundleBuckets buckets;
        const auto &bundles = bundle(pairs);
        buckets(bundles);
        BundleCombinations combine;
        combine.most = 10000000;
        combine.keep = 4;
        const std::vector<Combination> few = combine(buckets);
        combine.keep = 1000000; // nothing is ever cut off
        const std::vector<Combination> all = combine(buckets);
        QVERIFY(!combine.isCut());
        QCOMPARE(few.size(), std::min<std::size_t>(4, all.size()));
        if (!all.empty())
            QCOMPARE(few[0].length, all[0].length);
    }
}

void TestCorrespondence::boundOnCombinationsIsReported() {
    const RandomRoom made(4);
    CorrespondenceFinder find;
    find.settings.maxCombinations = 3;
    const auto &result = find(seenFrom(made.edges, made.first), seenFrom(made.edges, made.second));
    QVERIFY(result.outcome == SearchOutcome::Cut);
    QCOMPARE(result.combinations, std::uint64_t(3));
    QVERIFY(QByteArray(describe(result.outcome)).contains("bound"));
    find.settings.maxCombinations = 100000;
    QVERIFY(find(seenFrom(made.edges, made.first), seenFrom(made.edges, made.second)).outcome ==
            SearchOutcome::Complete);
}

void TestCorrespondence::findsThePoseOfRandomRooms() {
    const unsigned seed = std::random_device()();
    qInfo("seed %u", seed);
    CorrespondenceFinder find;
    for (unsigned k = 0; k < 200; ++k) {
        const RandomRoom made(seed + k);
        const auto &result = find(seenFrom(made.edges, made.first), seenFrom(made.edges, made.second));
        const QByteArray which = "room " + QByteArray::number(seed + k);
        QVERIFY2(!result.solutions.empty() && result.solutions[0].accepted, which);
        QVERIFY2(distance(result.solutions[0].pose, between(made.first, made.second)) < 1e-6, which);
    }
}

void TestCorrespondence::expectedTransformationMovesTheSearch() {
    const Pose2D first{-1, 0.2, 0.3}, second{1.4, -0.5, 2.5}; // farther than the permitted set reaches
    CorrespondenceFinder find;
    const Transformation2D truth = between(first, second);
    const auto &result =
        find(seenFrom(room(), first), seenFrom(room(), second), truth * Transformation2D(0.3, -0.4, 0.2));
    QVERIFY(!result.solutions.empty() && result.solutions[0].accepted);
    QVERIFY(distance(result.solutions[0].pose, truth) < 1e-6);
}

void TestCorrespondence::otherDirectionsAreOutOfThePermittedSet() {
    CorrespondenceFinder find;
    find.settings.permitted = {0.3, 0.3, 0.1};
    for (const Solution &s : find(seenFrom(room(), {0, 0, 0}), seenFrom(room(), {1, 0, 0})).solutions)
        QVERIFY(!s.accepted);
}

void TestCorrespondence::everySymmetryIsASolution() {
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

void TestCorrespondence::viewThatSeesNothingIsNoEvidence() {
    // An outer corner fits upside down as well, from where it would be seen from behind.
    const Segments corner = {Segment({1, 1}, {1, -1}).reversed(), Segment({1, 1}, {-1, 1})};
    const Segments other = {Segment({-3, -3}, {-3, -3.8}), Segment({-3.8, -3}, {-3, -3})};
    ExpectedViewTest test;
    test.setFixed(other);
    test.setMoving(corner);
    QVERIFY(test(Transformation2D()).angle == 0);
    QVERIFY(test(Transformation2D()).discrepancy == 0);
    CorrespondenceFinder find;
    find.settings.permitted = {9, 9, 1};
    for (const Solution &s :
         find(moved({5, 5, 0}, {corner[0].reversed(), corner[1].reversed()}), corner).solutions)
        QVERIFY(!s.accepted || s.view.angle > 0);
    find.settings.sharedView = find.settings.matchedShare = 0;
    find.settings.permitted = {9, 9, 3.2};
    for (const Solution &s :
         find(moved({-1, -1, pi}, {corner[0].reversed(), corner[1].reversed()}), corner).solutions)
        QVERIFY(s.view.angle > 0 || (!s.accepted && s.score == 0));
}

void TestCorrespondence::numbersAreThoseOfTheCaller() {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Segments bad = {Segment({nan, 0}, {1, 1}), Segment({1, 1}, {1, 1}), Segment({0, 0}, {0, noHit})};
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

void TestCorrespondence::searchesAMap() {
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

void TestCorrespondence::mapSearchDoesNotSlowDownWithTheMap() {
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

void TestCorrespondence::saysWhyThereIsNothing_data() {
    QTest::addColumn<int>("which");
    QTest::addColumn<int>("outcome");
    const char *names[] = {"nothing static",
                           "nothing dynamic",
                           "only bad segments",
                           "too far apart",
                           "one wall",
                           "corridor",
                           "other angle between the walls",
                           "NaN threshold",
                           "negative threshold",
                           "no solution wanted",
                           "infinite reach",
                           "NaN pose",
                           "too many pairs"};
    const SearchOutcome outcomes[] = {
        SearchOutcome::NothingFixed,    SearchOutcome::NothingMoving, SearchOutcome::NothingMoving,
        SearchOutcome::NoPotentialPair, SearchOutcome::OneDirection,  SearchOutcome::OneDirection,
        SearchOutcome::NoCombination,   SearchOutcome::BadSettings,   SearchOutcome::BadSettings,
        SearchOutcome::BadSettings,     SearchOutcome::BadSettings,   SearchOutcome::BadSettings,
        SearchOutcome::TooManyPairs};
    for (int i = 0; i < 13; ++i)
        QTest::newRow(names[i]) << i << static_cast<int>(outcomes[i]);
}

void TestCorrespondence::saysWhyThereIsNothing() {
    QFETCH(int, which);
    QFETCH(int, outcome);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CorrespondenceFinder find;
    Segments fixed = room(), moving = room();
    Transformation2D expected;
    switch (which) {
    case 0:
        fixed.clear();
        break;
    case 1:
        moving.clear();
        break;
    case 2:
        moving = {Segment({nan, 0}, {1, 1}), Segment({1, 1}, {1, 1})};
        break;
    case 3:
        expected = Transformation2D(100, 0, 0);
        break;
    case 4:
        moving = {Segment({2, -1}, {2, 1})};
        fixed = moving;
        break;
    case 5:
        fixed = moving = {Segment({2, -1}, {2, 1}), Segment({-2, 3}, {-2, -3})};
        break;
    case 6:
        fixed = {Segment({2, -1}, {2, 1}), Segment({2, 1}, {-2, 1})};
        moving = {Segment({2, -1}, {2, 1}), Segment({1.5, 1}, {-1.5, 3})};
        break;
    case 7:
        find.settings.ambiguity = nan;
        break;
    case 8:
        find.settings.permitted.dx = -1;
        break;
    case 9:
        find.settings.maxSolutions = 0;
        break;
    case 10:
        find.settings.permitted.dy = noHit;
        break;
    case 11:
        expected = Transformation2D(nan, 0, 0);
        break;
    case 12:
        find.settings.maxPairs = 3;
        break;
    }
    const auto &result = find(fixed, moving, expected);
    QCOMPARE(QByteArray(describe(result.outcome)), QByteArray(describe(SearchOutcome(outcome))));
    QVERIFY(result.solutions.empty());
}

void TestCorrespondence::tellsTheFaultOfASolution() {
    Segments moving = room();
    moving[0] = Segment(moving[0].begin() + Point(0, 0.02), moving[0].end()); // as noise does
    const auto fault = [&](auto change) {
        CorrespondenceFinder find;
        change(find.settings);
        const auto &solutions = find(room(), moving).solutions;
        if (solutions.empty() || solutions[0].accepted != (solutions[0].fault == Fault::None))
            qFatal("no solution, or one that is accepted and has a fault");
        return solutions[0].fault;
    };
    QVERIFY(fault([](SearchSettings &) {}) == Fault::None);
    QVERIFY(fault([](SearchSettings &s) { s.matchedShare = 1.1; }) == Fault::MatchedShare);
    QVERIFY(fault([](SearchSettings &s) { s.sharedView = 2; }) == Fault::NoEvidence);
    QVERIFY(fault([](SearchSettings &s) { s.discrepancy = s.discrepancyShare = 0; }) == Fault::Discrepancy);
}

void TestCorrespondence::thresholdsOfZeroAcceptNothing_data() {
    QTest::addColumn<int>("which");
    for (int i = 0; i < 6; ++i)
        QTest::addRow("threshold %d", i) << i;
}

void TestCorrespondence::thresholdsOfZeroAcceptNothing() {
    QFETCH(int, which);
    CorrespondenceFinder find;
    SearchSettings &s = find.settings;
    double *thresholds[] = {&s.permitted.dx, &s.permitted.dalpha, &s.reliability,
                            &s.ambiguity,    &s.discrepancy,      &s.stiffness.alpha};
    *thresholds[which] = 0;
    s.discrepancyShare = 0;
    Segments moving;
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 0.02);
    for (const Segment &edge : room()) {
        const Segment there = Transformation2D(-0.3, 0.1, 0.2) * edge;
        moving.emplace_back(there.begin() + Point(noise(random), noise(random)),
                            there.end() + Point(noise(random), noise(random)));
    }
    const bool mayAccept = thresholds[which] == &s.reliability || thresholds[which] == &s.stiffness.alpha;
    for (const Solution &solution : find(room(), moving).solutions) {
        QVERIFY(mayAccept || !solution.accepted);
        QVERIFY(solution.pose.isFinite() && solution.score >= 0 && solution.score <= 1);
    }
}

void TestCorrespondence::givesTheSameAgain() {
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

void TestCorrespondence::allocatesNothingInSteadyState() {
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

QTEST_APPLESS_MAIN(TestCorrespondence)
#include "TestCorrespondence.moc"
