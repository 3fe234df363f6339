#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CollinearBundles.h"
#include "vectorlib/correspondence/CorrespondenceTracker.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/correspondence/PotentialPairs.h"
#include "vectorlib/correspondence/SearchResult.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/observation/Discrepancy.h"
#include "vectorlib/observation/Observer.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <vector>

namespace vectorlib {

/// Static segments with a spatial index, so that the cost of a search follows its region and not the map.
class SegmentMap {
public:
    /// Adds a segment; returns its number. One that is not finite gets a number and is never found.
    int add(const LineSegment2D<double> &segment);
    std::size_t size() const { return segments_.size(); }
    const LineSegment2D<double> &operator[](int number) const {
        return segments_[static_cast<std::size_t>(number)];
    }
    /// Numbers of the segments near a square of the given half side, in order, and perhaps of some more;
    /// valid until the next call. None for what is not finite.
    const std::vector<int> &near(Vector2D<double> middle, double reach);

private:
    static constexpr double cell = 2;       // metres
    static constexpr double longest = 2000; // metres; longer segments are in too many cells

    std::vector<LineSegment2D<double>> segments_;
    SegmentGrid grid_{cell};
    std::vector<int> long_;
    std::vector<int> found_;
};

/// Compares what a sensor would see of the static set from a pose with what it saw. Thesis 7.4.2. Keeps its
/// buffers.
class ExpectedViewTest {
public:
    using Segments = std::vector<LineSegment2D<double>>;

    /// The static set, all in one frame. Where it is one scan, seen from `seenFrom`, what that pose did not
    /// see hides what lies behind; a map that grew from many poses has no such place.
    void setFixed(const Segments &fixed, const Transformation2D *seenFrom = nullptr);
    /// The dynamic set, in the sensor's frame.
    void setMoving(const Segments &moving);
    /// For a sensor that stands at `pose` among the static set.
    ViewComparison operator()(const Transformation2D &pose) {
        return compare_(observe_(*fixed_, pose.pose(), obstacles_), observed_);
    }
    /// Under which the dynamic set is seen; radians.
    double observedAngle() const { return observedAngle_; }
    /// The sectors of the last comparison, in the sensor's frame; for pictures.
    const std::vector<SharedSector> &sectors() const { return compare_.sectors(); }

private:
    const Segments *fixed_ = nullptr;
    Observer<double> observe_;
    Frontier frontier_;
    Discrepancy compare_;
    Segments obstacles_;
    std::vector<VisiblePart<double>> observed_;
    double observedAngle_ = 0;
};

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
