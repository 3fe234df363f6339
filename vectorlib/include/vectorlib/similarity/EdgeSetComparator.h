#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <vector>

namespace vectorlib {

/// How unlike two segments are, as an area: 0 exactly when both lie on one line; m^4. With x and y from begin
/// to end of the two, the squared parallelogram of x and y, and how far the middle of `moving` lies beside
/// the line of `fixed`. Thesis (7.7) to (7.9). Which way a segment runs does not matter.
inline double areaCriterion(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving) {
    const Vector2D<double> a = fixed.begin(), b = fixed.end(), x = b - a;
    const double parallelogram = x.cross(moving.end() - moving.begin());
    const double beside = x.cross(a + b + moving.begin() + moving.end() - 4.0 * a); // 64 S_ABS^2, squared
    return parallelogram * parallelogram + beside * beside;
}

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
    bool add(const SegmentPair &pair) {
        if (!mayBeAdded(pair))
            return false;
        const Sums own = sumsOf(pair);
        if (!std::isfinite(trace(sums_) + trace(own)))
            return false;
        take(own);
        return true;
    }
    /// The same for two segments.
    bool add(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving, double weight = 1) {
        return add({fixed, moving, weight});
    }
    /// Adds all that are usable; returns how many those are.
    std::size_t add(const std::vector<SegmentPair> &pairs) {
        EdgeSetComparator sum = *this; // in registers
        for (const SegmentPair &pair : pairs)
            if (mayBeAdded(pair))
                sum.take(sumsOf(pair));
        if (!std::isfinite(trace(sum.sums_)))
            return addOneByOne(pairs);
        const int added = sum.pairs_ - pairs_;
        *this = sum;
        return static_cast<std::size_t>(added);
    }
    /// Adds all pairs of another set.
    void add(const EdgeSetComparator &o) {
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] += o.sums_[i];
        pairs_ += o.pairs_;
    }
    /// Takes away a pair that was added with the same weight; false for what cannot have been added.
    bool remove(const SegmentPair &pair) {
        if (pairs_ == 0 || !isUsable(pair))
            return false;
        const Sums own = sumsOf(pair);
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] -= own[i];
        drop(1);
        return true;
    }
    /// Takes away all pairs of another set; false when it has more than there are.
    bool remove(const EdgeSetComparator &o) {
        if (o.pairs_ > pairs_)
            return false;
        const EdgeSetComparator other = o; // it may be this one
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] -= other.sums_[i];
        drop(other.pairs_);
        return true;
    }
    void clear() { *this = EdgeSetComparator(); }
    int pairs() const { return pairs_; }

    /// The criterion when t moves the dynamic set; m^4, 0 without pairs.
    double operator()(const Transformation2D &t) const {
        const Sums &m = sums_;
        const double c = t.cos(), s = t.sin(), x = t.x(), y = t.y();
        const double both = c * (s * m[1] + x * m[2] + y * m[3] + m[4]) + s * (x * m[6] + y * m[7] + m[8]) +
                            x * (y * m[10] + m[11]) + y * m[13];
        const double squares = c * c * m[0] + s * s * m[5] + x * x * m[9] + y * y * m[12] + m[14];
        return std::max(squares + 2 * both, 0.0); // rounding must not make it negative; NaN stays NaN
    }

    /// The criterion, its gradient and Hessian by (x, y, alpha).
    CriterionExpansion expansion(const Transformation2D &t) const {
        const Sums &m = sums_;
        const double c = t.cos(), s = t.sin(), x = t.x(), y = t.y();
        const double mu[] = {c * m[0] + s * m[1] + x * m[2] + y * m[3] + m[4],
                             c * m[1] + s * m[5] + x * m[6] + y * m[7] + m[8],
                             c * m[2] + s * m[6] + x * m[9] + y * m[10] + m[11],
                             c * m[3] + s * m[7] + x * m[10] + y * m[12] + m[13]}; // of M u
        CriterionExpansion e;
        e.value = (*this)(t);
        e.gradient << 2 * mu[2], 2 * mu[3], 2 * (c * mu[1] - s * mu[0]);
        // With alpha u turns along (-s, c), and bends by -(c, s).
        const double xAlpha = c * m[6] - s * m[2], yAlpha = c * m[7] - s * m[3];
        const double alpha = s * s * m[0] - 2 * s * c * m[1] + c * c * m[5] - c * mu[0] - s * mu[1];
        e.hessian << m[9], m[10], xAlpha, m[10], m[12], yAlpha, xAlpha, yAlpha, alpha;
        e.hessian *= 2;
        return e;
    }

private:
    using Sums = std::array<double, 15>; // the upper triangle of M, row by row

    // Ends that are not finite are found in the sums, which they make not finite.
    static bool mayBeAdded(const SegmentPair &p) {
        return p.fixed.direction().squaredNorm() > 0.5 && p.moving.direction().squaredNorm() > 0.5 &&
               p.weight > 0;
    }
    void take(const Sums &own) {
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] += own[i];
        ++pairs_;
    }
    std::size_t addOneByOne(const std::vector<SegmentPair> &pairs) {
        std::size_t added = 0;
        for (const SegmentPair &pair : pairs)
            added += add(pair);
        return added;
    }
    static double trace(const Sums &s) { return s[0] + s[5] + s[9] + s[12] + s[14]; }

    static Sums sumsOf(const SegmentPair &p) {
        const Vector2D<double> a = p.fixed.begin(), b = p.fixed.end(), c = p.moving.begin(),
                               d = p.moving.end();
        const Vector2D<double> x = b - a, y = d - c, z = d + c, v = b - 3.0 * a;
        const double g0 = x.cross(z), g1 = x.dot(z), g2 = -2 * x.y, g3 = 2 * x.x, g4 = x.cross(v); // (7.17)
        const double cross = x.cross(y), dot = x.dot(y);                                           // (7.16)
        const double w = p.weight, w0 = w * g0, w1 = w * g1, w2 = w * g2, w3 = w * g3;
        return {w0 * g0 + w * cross * cross,
                w0 * g1 + w * cross * dot,
                w0 * g2,
                w0 * g3,
                w0 * g4,
                w1 * g1 + w * dot * dot,
                w1 * g2,
                w1 * g3,
                w1 * g4,
                w2 * g2,
                w2 * g3,
                w2 * g4,
                w3 * g3,
                w3 * g4,
                w * g4 * g4};
    }
    void drop(int count) {
        pairs_ -= count;
        if (pairs_ == 0)
            clear();
    }

    Sums sums_{};
    int pairs_ = 0;
};

} // namespace vectorlib
