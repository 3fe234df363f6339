#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/BundleBuckets.h"
#include "vectorlib/correspondence/BundleCombinations.h"
#include "vectorlib/correspondence/CollinearBundles.h"
#include "vectorlib/correspondence/ExpectedViewTest.h"
#include "vectorlib/correspondence/NumberedSegments.h"
#include "vectorlib/correspondence/PairCollector.h"
#include "vectorlib/correspondence/PairSelection.h"
#include "vectorlib/correspondence/PotentialPair.h"
#include "vectorlib/correspondence/SearchResult.h"
#include "vectorlib/correspondence/SearchSettings.h"
#include "vectorlib/correspondence/SegmentMap.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <vector>

namespace vectorlib {

/// Finds which segments of two sets correspond, with no more knowledge than a set of permitted
/// transformations. Thesis 7.4: potential pairs, unambiguous collinear bundles, their combinations, expected
/// view test. Keeps its buffers between calls.
///
/// Segments that are not finite or have no length are left out. Where there is no solution, the outcome says
/// why.
class CorrespondenceFinder {
public:
    using Segments = std::vector<LineSegment2D<double>>;

    SearchSettings settings;

    /// Two scans, each in the frame of its sensor; `expected` moves the dynamic set onto the static one.
    /// Valid until the next call.
    const SearchResult &operator()(const Segments &fixed, const Segments &moving,
                                   const Transformation2D &expected = {});
    /// A scan in a map: only what lies in reach of the scan is looked at. Pairs bear the map's numbers.
    const SearchResult &operator()(SegmentMap &map, const Segments &moving,
                                   const Transformation2D &expected = {});

private:
    bool start(const Segments &moving, const Transformation2D &expected);

    // Everything happens in the expected sensor frame, where segments are near the origin (erratum 13).
    void search(const Transformation2D *seenFrom);
    SearchOutcome findCombinations();
    // Makes a solution of the selected pairs and the transformation that fits them.
    void judge(const Transformation2D &t);
    Fault faultOf(const Solution &s, const Transformation2D &t) const;
    // What the pairs themselves tell.
    void measure(Solution &s, const Transformation2D &t);
    // One of the last call, for the memory of its pairs.
    Solution emptySolution();

    Transformation2D expected_, toLocal_;
    NumberedSegments fixed_, moving_; // in the expected sensor frame
    PairCollector collect_;
    std::vector<PotentialPair> pairs_;
    CollinearBundles bundle_;
    BundleBuckets buckets_;
    BundleCombinations combine_;
    const std::vector<Combination> none_{};
    const std::vector<Combination> *combinations_ = &none_;
    PairSelection select_;
    ExpectedViewTest view_;
    LineSegmentRegistration sums_;
    std::vector<char> isMatched_;
    std::vector<Solution> spare_;
    SearchResult result_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/CorrespondenceFinder.cpp")
