#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/SegmentPair.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace vectorlib {

/// How unlike two segments are, as an area: 0 exactly when both lie on one line; m^4. With x and y from begin
/// to end of the two, the squared parallelogram of x and y, and how far the middle of `moving` lies beside
/// the line of `fixed`. Thesis (7.7) to (7.9). Which way a segment runs does not matter.
double areaCriterion(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving);

/// The criterion with its derivatives by x, y (metres) and alpha (radians).
struct CriterionExpansion {
    double value = 0; ///< m^4
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

/// How unlike two sets of segments with known correspondences are, for any transformation of the dynamic set:
/// the weighted sum of areaCriterion() over all pairs, thesis (7.18). Pairs, or the sums of whole sets of
/// pairs, are added and removed in constant time, and the criterion and its derivatives take constant time
/// whatever the number of pairs.
///
/// With u = (cos, sin, x, y, 1) of the transformation every squared term of (7.16) and (7.17) is (g.u)^2 for
/// a vector g of the pair, so that the eighteen sums of (7.18) are the fifteen of one symmetric matrix: the
/// criterion is u' M u. Every cross product is signed (erratum 11).
///
/// Give segments in a frame near them: far from the origin the sums cancel (erratum 13).
class EdgeSetComparator {
public:
    /// Adds a pair; false (and nothing added) when it is not usable or beyond what a double holds.
    bool add(const SegmentPair &pair);
    /// The same for two segments.
    bool add(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving, double weight = 1) {
        return add({fixed, moving, weight});
    }
    /// Adds all that are usable; returns how many those are.
    std::size_t add(const std::vector<SegmentPair> &pairs);
    /// Adds all pairs of another set.
    void add(const EdgeSetComparator &o);
    /// Takes away a pair that was added with the same weight; false for what cannot have been added.
    bool remove(const SegmentPair &pair);
    /// Takes away all pairs of another set; false when it has more than there are.
    bool remove(const EdgeSetComparator &o);
    void clear() { *this = EdgeSetComparator(); }
    int pairs() const { return pairs_; }

    /// The criterion when t moves the dynamic set; m^4, 0 without pairs.
    double operator()(const Transformation2D &t) const;

    /// The criterion, its gradient and Hessian by (x, y, alpha).
    CriterionExpansion expansion(const Transformation2D &t) const;

private:
    using Sums = std::array<double, 15>; // the upper triangle of M, row by row

    // Ends that are not finite are found in the sums, which they make not finite.
    static bool mayBeAdded(const SegmentPair &p);
    void take(const Sums &own);
    std::size_t addOneByOne(const std::vector<SegmentPair> &pairs);
    static double trace(const Sums &s) { return s[0] + s[5] + s[9] + s[12] + s[14]; }

    static Sums sumsOf(const SegmentPair &p);
    void drop(int count);

    Sums sums_{};
    int pairs_ = 0;
};

} // namespace vectorlib

#ifdef VECTORLIB_HEADER_ONLY
#include "vectorlib/src/similarity/EdgeSetComparator.cpp"
#endif
