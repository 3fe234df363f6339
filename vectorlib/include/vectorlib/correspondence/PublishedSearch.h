#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CorrespondenceFinder.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/correspondence/PotentialPairs.h"
#include "vectorlib/correspondence/SearchResult.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// Pairs with nearly parallel lines that agree on the rotation and on the shift across the lines; together
/// they leave the shift along them open.
struct PublishedBundle {
    LineSegmentRegistration sums;
    std::vector<int> pairs; ///< numbers of potential pairs
    std::size_t bucket = 0;
    Vector2D<double> normal;        ///< of its first pair
    double alpha = 0;               ///< of its first pair; radians
    double turns = 0, turns2 = 0;   ///< weighted sums of rotations beside that, and of their squares
    double shifts = 0, shifts2 = 0; ///< the same of shifts along the normal

    explicit PublishedBundle(const PotentialPair &first)
        : normal(first.normal)
        , alpha(first.alpha) {
        sums.stiffness = first.sums.stiffness;
    }
    /// Takes a pair into the sums, not into `pairs`.
    void add(const PotentialPair &pair);
    double length() const { return sums.weight(); } ///< of the shorter segments of its pairs; metres
    /// The sum (7.44) over the pairs where the lines are parallel: of rotation and of shift across; m^2.
    double ambiguity() const {
        const double w = sums.weight();
        return sums.stiffness.alpha * std::max(0.0, turns2 - turns * turns / w) +
               sums.stiffness.xy * std::max(0.0, shifts2 - shifts * shifts / w);
    }
};

/// Bundles and buckets by the rules as published, thesis 7.4.1; CollinearBundles and BundleBuckets, which
/// CorrespondenceFinder uses, mend them. A pair joins the first bundle that with it keeps both thresholds,
/// else it founds one. A bundle lies in the first bucket whose bundles it leaves unreliable, each of them.
///
/// Where the text leaves it open: pairs come by static, then dynamic segment; a pair weighs as many as its
/// shorter segment has metres (registration paper 4); and since a bundle can be shifted along its lines, its
/// ambiguity is that across them. At the optimum (7.26) lines that are nearly parallel meet far away, where
/// they cross: an ambiguity of 0, whatever lies between them. For reports and comparisons: allocates.
class PublishedBundles {
public:
    double reliability = 0.10; ///< most of a bundle
    double ambiguity = 0.0025; ///< most of a bundle; m^2

    /// Sorts pairs into bundles, and the bundles into buckets(). The bundles are in the order in which they
    /// were founded; valid until the next call.
    const std::vector<PublishedBundle> &operator()(const std::vector<PotentialPair> &pairs);
    const std::vector<PublishedBundle> &bundles() const { return bundles_; }
    /// The numbers of the bundles of each bucket.
    const std::vector<std::vector<std::size_t>> &buckets() const { return buckets_; }

private:
    void place(const PotentialPair &pair, int number);
    bool collide(std::size_t a, std::size_t b) const;
    void putIntoBucket(std::size_t bundle);

    std::vector<PublishedBundle> bundles_;
    std::vector<std::vector<std::size_t>> buckets_;
};

/// Bundles of two or more buckets that together are reliable and not ambiguous.
struct PublishedCombination {
    LineSegmentRegistration sums;
    std::vector<std::size_t> bundles; ///< their numbers

    double length() const { return sums.weight(); } ///< metres
};

/// Every reliable, unambiguous combination of bundles, at most one of each bucket; thesis 7.4.1, last stage.
/// One to which another bundle can be added is told in the number of parts only: the appendices show none of
/// them. Energy (7.44) only grows as bundles join, so that a branch ends where it is beyond the threshold.
class PublishedCombinations {
public:
    double reliability = 0.10;    ///< least of a combination
    double ambiguity = 0.0025;    ///< most of a combination; m^2
    std::size_t keep = 100;       ///< the longest ones
    std::uint64_t most = 1000000; ///< bundles tried; then the search ends with what it has

    /// Longest first; valid until the next call.
    const std::vector<PublishedCombination> &operator()(const PublishedBundles &sorted);
    std::uint64_t found() const { return found_; }                           ///< all of them
    std::uint64_t parts() const { return parts_; }                           ///< parts of larger ones
    std::uint64_t leftOut() const { return found_ - parts_ - kept_.size(); } ///< beyond `keep`
    std::uint64_t tried() const { return tried_; }                           ///< bundles
    bool isCut() const { return cut_; } ///< whether `most` ended the search before its end

private:
    const PublishedBundle &bundle(std::size_t number) const { return sorted_->bundles()[number]; }

    // Whether a bundle may join; false, too, where the bound is reached.
    bool joins(std::size_t number, const LineSegmentRegistration &sums, LineSegmentRegistration &joint);
    void extend(std::size_t bucket, const LineSegmentRegistration &sums);
    void conclude(const LineSegmentRegistration &sums);
    bool isPart(const LineSegmentRegistration &sums);

    const PublishedBundles *sorted_ = nullptr;
    std::vector<std::size_t> chosen_;
    std::vector<PublishedCombination> kept_;
    std::uint64_t found_ = 0, parts_ = 0, tried_ = 0;
    bool cut_ = false;
};

/// What PublishedSearch found.
struct PublishedResult {
    /// Its solutions are the combinations, longest first. Their ambiguity is the sum (7.44). Accepted are
    /// those of a permitted transformation whose discrepancy keeps its threshold. There is no score.
    SearchResult search;
    /// For each solution what CorrespondenceFinder asks besides and the published rules do not: NoEvidence or
    /// MatchedShare where it would refuse it, else None.
    std::vector<Fault> doubts;
    std::uint64_t found = 0;   ///< combinations that are reliable and unambiguous
    std::uint64_t parts = 0;   ///< of these parts of larger ones, which are not among the solutions
    std::uint64_t leftOut = 0; ///< of these beyond the most solutions
};

/// The correspondence search of thesis 7.4 to the letter: PublishedBundles, all PublishedCombinations, and
/// the transformation of each as it follows from its sums. For comparison with CorrespondenceFinder.
class PublishedSearch {
public:
    using Segments = std::vector<LineSegment2D<double>>;

    SearchSettings settings; ///< all but maxSolutions and maxCombinations, which are those of `combine`
    PublishedCombinations combine;

    /// Two scans, each in the frame of its sensor; `expected` moves the dynamic set onto the static one.
    /// Valid until the next call.
    const PublishedResult &operator()(const Segments &fixed, const Segments &moving,
                                      const Transformation2D &expected = {});
    /// Of the last call; pairs in the order of static, then dynamic segments.
    const std::vector<PotentialPair> &pairs() const { return pairs_; }
    const PublishedBundles &bundles() const { return bundle_; }

private:
    SearchOutcome findCombinations();
    void judge(const PublishedCombination &combination, const Transformation2D &expected);
    Fault doubtOf(const Solution &s) const {
        return !settings.isEvidence(s.view, view_.observedAngle()) ? Fault::NoEvidence
               : !(s.matchedShare >= settings.matchedShare)        ? Fault::MatchedShare
                                                                   : Fault::None;
    }

    NumberedSegments fixed_, moving_; // in the expected sensor frame
    PairCollector collect_;
    std::vector<PotentialPair> pairs_;
    PublishedBundles bundle_;
    const std::vector<PublishedCombination> none_{};
    const std::vector<PublishedCombination> *combinations_ = &none_;
    ExpectedViewTest view_;
    PublishedResult result_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/PublishedSearch.cpp")
