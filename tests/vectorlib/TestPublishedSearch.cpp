#include "RoomScans.h"

#include "tests/support/RandomRoom.h"
#include "vectorlib/correspondence/PublishedSearch.h"

using namespace vectorlib;

/// The search of thesis 7.4 to the letter.
class TestPublishedSearch : public QObject {
    Q_OBJECT

    /// Walls in two directions: `across` of them 40 cm apart that face one way, `along` that face across.
    static Segments twoDirections(int across, int along) {
        Segments walls;
        for (int i = 0; i < across; ++i)
            walls.push_back(Segment({2 + 0.4 * i, -1}, {2 + 0.4 * i, 1}));
        for (int i = 0; i < along; ++i)
            walls.push_back(Segment({1, 3 + 0.4 * i}, {-1, 3 + 0.4 * i}));
        return walls;
    }

    static double ambiguityOf(const PublishedSearch &search, const std::vector<std::size_t> &bundles) {
        LineSegmentRegistration sums;
        sums.stiffness = search.settings.stiffness;
        for (const std::size_t bundle : bundles)
            sums.add(search.bundles().bundles()[bundle].sums);
        return sums.ambiguity().total();
    }
    static double reliabilityOf(const PublishedSearch &search, const std::vector<std::size_t> &bundles) {
        LineSegmentRegistration sums;
        for (const std::size_t bundle : bundles)
            sums.add(search.bundles().bundles()[bundle].sums);
        return sums.reliability();
    }

    /// All choices of at most one bundle of each bucket.
    static void forEachChoice(const PublishedBundles &sorted, std::size_t bucket,
                              std::vector<std::size_t> &chosen, const std::function<void()> &take) {
        if (bucket == sorted.buckets().size())
            return take();
        forEachChoice(sorted, bucket + 1, chosen, take);
        for (const std::size_t bundle : sorted.buckets()[bucket]) {
            chosen.push_back(bundle);
            forEachChoice(sorted, bucket + 1, chosen, take);
            chosen.pop_back();
        }
    }

private Q_SLOTS:
    // As in thesis figure 7.18: five positions in one direction and three in the other are 15 solutions.
    void everyPositionOfOneDirectionMeetsEveryOneOfTheOther() {
        PublishedSearch search;
        const Segments scan = twoDirections(3, 2);
        const PublishedResult &found = search(scan, scan);
        QCOMPARE(found.search.potentialPairs, std::size_t(9 + 4));
        QCOMPARE(found.search.bundles, std::size_t(5 + 3));
        QCOMPARE(found.search.buckets, std::size_t(2));
        QCOMPARE(found.search.solutions.size(), std::size_t(15));
        QCOMPARE(found.found, std::uint64_t(15));
        QCOMPARE(found.parts, std::uint64_t(0));
        QVERIFY(found.search.outcome == SearchOutcome::Complete);
        const Solution &longest = found.search.solutions[0]; // where all walls meet themselves
        QCOMPARE(longest.pairs.size(), std::size_t(5));
        QVERIFY(longest.pose.translation().norm() < 1e-9 && std::abs(longest.pose.alpha()) < 1e-9);
        QVERIFY(longest.accepted && longest.ambiguity < 1e-12 && longest.view.discrepancy < 1e-9);
    }

    void rulesHoldInRandomRooms() {
        const unsigned seed = newSeed();
        for (unsigned k = 0; k < 100; ++k) {
            const RandomRoom made(seed + k);
            PublishedSearch search;
            const PublishedResult &found =
                search(seenFrom(made.edges, made.first), seenFrom(made.edges, made.second));
            std::set<int> placed;
            for (const PublishedBundle &bundle : search.bundles().bundles()) {
                QVERIFY(bundle.sums.reliability() <= search.settings.reliability);
                QVERIFY(bundle.ambiguity() <= search.settings.ambiguity);
                for (const int pair : bundle.pairs)
                    QVERIFY(placed.insert(pair).second);
            }
            QCOMPARE(placed.size(), search.pairs().size());
            for (const auto &bucket : search.bundles().buckets())
                for (const std::size_t a : bucket)
                    for (const std::size_t b : bucket)
                        QVERIFY(reliabilityOf(search, {a, b}) <= search.settings.reliability);
            QCOMPARE(found.doubts.size(), found.search.solutions.size());
            for (const Solution &s : found.search.solutions) {
                QVERIFY(s.reliability >= search.settings.reliability);
                QVERIFY(s.ambiguity <= search.settings.ambiguity);
                QCOMPARE(s.accepted, s.fault == Fault::None);
            }
        }
    }

    void combinationsAreThoseOfExhaustiveSearch() {
        const unsigned seed = newSeed();
        int compared = 0;
        for (unsigned k = 0; k < 100; ++k) {
            const RandomRoom made(seed + k);
            PublishedSearch search;
            search.combine.keep = 100000;
            search(seenFrom(made.edges, made.first), seenFrom(made.edges, made.second));
            double choices = 1;
            for (const auto &bucket : search.bundles().buckets())
                choices *= double(bucket.size() + 1);
            if (choices > 20000)
                continue;
            ++compared;
            std::vector<std::size_t> chosen;
            std::vector<std::set<std::size_t>> valid;
            forEachChoice(search.bundles(), 0, chosen, [&] {
                if (chosen.size() > 1 && ambiguityOf(search, chosen) <= search.settings.ambiguity &&
                    reliabilityOf(search, chosen) >= search.settings.reliability)
                    valid.emplace_back(chosen.begin(), chosen.end());
            });
            const std::set<std::set<std::size_t>> all(valid.begin(), valid.end());
            std::size_t parts = 0;
            for (const auto &combination : all)
                parts += std::any_of(all.begin(), all.end(), [&](const auto &other) {
                    return other.size() == combination.size() + 1 &&
                           std::includes(other.begin(), other.end(), combination.begin(), combination.end());
                });
            QCOMPARE(search.combine.found(), std::uint64_t(all.size()));
            QCOMPARE(search.combine.parts(), std::uint64_t(parts));
            QCOMPARE(search.combine.leftOut(), std::uint64_t(0));
        }
        QVERIFY(compared > 20);
    }

    void boundsAreTold() {
        PublishedSearch search;
        const Segments scan = twoDirections(3, 2);
        search.combine.keep = 4;
        const PublishedResult &found = search(scan, scan);
        QCOMPARE(found.search.solutions.size(), std::size_t(4));
        QCOMPARE(found.leftOut, std::uint64_t(11));
        QVERIFY(found.search.outcome == SearchOutcome::Complete);
        search.combine.most = 10;
        QVERIFY(search(scan, scan).search.outcome == SearchOutcome::Cut);
        QCOMPARE(search(scan, scan).search.combinations, std::uint64_t(10));
        search.settings.maxPairs = 5;
        QVERIFY(search(scan, scan).search.outcome == SearchOutcome::TooManyPairs);
    }

    // Behind the wall that the second scan is laid upon nothing is seen: a discrepancy of 0 that the
    // published rules accept.
    void viewThatSeesNothingIsDoubted() {
        const Segments still = {Segment({1, -1}, {1, 1}), Segment({0.9, 1.1}, {-1, 1.1})};
        const Transformation2D behind(1.1, 0.1, 0); // beyond the first wall
        Segments moving;
        for (const Segment &s : still)
            moving.push_back(behind.inverse() * s);
        PublishedSearch search;
        const PublishedResult &found = search(still, moving);
        const auto at = std::find_if(
            found.search.solutions.begin(), found.search.solutions.end(), [&](const Solution &s) {
                return (s.pose.translation() - behind.translation()).norm() < 1e-6 && s.view.angle == 0;
            });
        QVERIFY(at != found.search.solutions.end());
        QVERIFY(at->accepted);
        QVERIFY(found.doubts[std::size_t(at - found.search.solutions.begin())] == Fault::NoEvidence);
    }

    void expectedTransformationMovesTheSearch() {
        const Segments scan = twoDirections(2, 2);
        const Transformation2D truth(5, -3, 2);
        PublishedSearch search;
        QVERIFY(search(moved(truth, scan), scan).search.outcome == SearchOutcome::NoPotentialPair ||
                search(moved(truth, scan), scan).search.solutions.empty());
        const PublishedResult &found =
            search(moved(truth, scan), scan, truth * Transformation2D(0.1, 0.1, 0.05));
        QVERIFY(!found.search.solutions.empty());
        QVERIFY((found.search.solutions[0].pose.translation() - truth.translation()).norm() < 1e-9);
        QVERIFY(found.search.solutions[0].accepted);
    }

    void saysWhyThereIsNothing() {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const Segments scan = twoDirections(2, 2), bad = {Segment({nan, 0}, {1, 1}), Segment({1, 1}, {1, 1})};
        PublishedSearch search;
        QVERIFY(search({}, scan).search.outcome == SearchOutcome::NothingFixed);
        QVERIFY(search(scan, bad).search.outcome == SearchOutcome::NothingMoving);
        QVERIFY(search(twoDirections(2, 0), scan).search.outcome == SearchOutcome::OneDirection);
        QVERIFY(search(scan, moved({1e300, 0, 0}, scan)).search.solutions.empty());
        QVERIFY(search(scan, scan, {nan, 0, 0}).search.outcome == SearchOutcome::BadSettings);
        search.settings.ambiguity = nan;
        QVERIFY(search(scan, scan).search.outcome == SearchOutcome::BadSettings);
    }
};
