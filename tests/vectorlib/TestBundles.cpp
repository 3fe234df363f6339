#include "RoomScans.h"

#include "tests/support/RandomRoom.h"
#include "vectorlib/correspondence/CorrespondenceFinder.h"

using namespace vectorlib;

/// Bundles of collinear pairs, their directions and combinations: the first half of the search, thesis 7.4.
class TestBundles : public QObject {
    Q_OBJECT

    static std::vector<PotentialPair> pairsOf(const Segments &fixed, const Segments &moving) {
        std::vector<PotentialPair> pairs;
        for (std::size_t m = 0; m < moving.size(); ++m)
            for (std::size_t f = 0; f < fixed.size(); ++f)
                if (mayCorrespond(fixed[f], moving[m], PermittedError()))
                    pairs.emplace_back(CorrespondencePair{int(f), int(m)}, fixed[f], moving[m], Stiffness());
        return pairs;
    }

private Q_SLOTS:
    void pairsOfOneShiftAreOneBundle() {
        // Two parts of one wall, and a wall 30 cm behind: 2 x 2 pairs without shift, 2 with 30 cm, 2 with -30
        // cm.
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

    void facingWallsAreOneBundle() {
        const Segments scan = {Segment({2, -1}, {2, 1}), Segment({-2, 1}, {-2, -1})};
        auto pairs = pairsOf(moved({0.5, 0.2, 0}, scan), scan);
        CollinearBundles bundle;
        QCOMPARE(bundle(pairs).size(), std::size_t(1));
        QCOMPARE(bundle(pairs)[0].sums.pairs(), 2);
    }

    void badPairDoesNotHideInALargeBundle() {
        Segments scan = {Segment({2, -4}, {2, 4})};
        std::vector<PotentialPair> pairs = pairsOf(scan, scan);
        pairs.emplace_back(CorrespondencePair{1, 1}, Segment({3.12, 0}, {3.12, 0.3}),
                           Segment({3, 0}, {3, 0.3}), Stiffness());
        CollinearBundles bundle;
        QCOMPARE(bundle(pairs).size(),
                 std::size_t(2)); // though 0.3 m of 12 cm beside 8 m is little on average
    }

    void bucketsAreDirections() {
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

    void combinationsAreThoseOfExhaustiveSearch() {
        const unsigned seed = newSeed();
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
};
