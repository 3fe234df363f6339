#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/ExpectedViewTest.h"
#include "vectorlib/correspondence/NumberedSegments.h"
#include "vectorlib/correspondence/PairCollector.h"
#include "vectorlib/correspondence/PotentialPair.h"
#include "vectorlib/correspondence/PublishedBundles.h"
#include "vectorlib/correspondence/PublishedCombinations.h"
#include "vectorlib/correspondence/SearchResult.h"
#include "vectorlib/correspondence/SearchSettings.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <cstdint>
#include <vector>

namespace vectorlib {

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
    Fault doubtOf(const Solution &s) const;

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
