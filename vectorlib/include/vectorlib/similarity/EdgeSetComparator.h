#pragma once

#include "vectorlib/geometry/SegmentPair.h"
#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <Eigen/Core>

#include <algorithm>
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
    double value = 0;
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
        if (!isUsable(pair))
            return false;
        const Matrix sum = m_ + matrixOf(pair);
        if (!std::isfinite(sum.trace()))
            return false;
        m_ = sum;
        ++pairs_;
        return true;
    }
    bool add(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving, double weight = 1) {
        return add({fixed, moving, weight});
    }
    /// Adds all that are usable; returns how many those are.
    std::size_t add(const std::vector<SegmentPair> &pairs) {
        std::size_t added = 0;
        for (const SegmentPair &pair : pairs)
            added += add(pair);
        return added;
    }
    /// Adds all pairs of another set.
    void add(const EdgeSetComparator &o) {
        m_ += Matrix(o.m_);
        pairs_ += o.pairs_;
    }
    /// Takes away a pair that was added with the same weight; false for what cannot have been added.
    bool remove(const SegmentPair &pair) {
        if (pairs_ == 0 || !isUsable(pair))
            return false;
        m_ -= matrixOf(pair);
        drop(1);
        return true;
    }
    /// Takes away all pairs of another set; false when it has more than there are.
    bool remove(const EdgeSetComparator &o) {
        if (o.pairs_ > pairs_)
            return false;
        m_ -= Matrix(o.m_);
        drop(o.pairs_);
        return true;
    }
    void clear() { *this = EdgeSetComparator(); }
    int pairs() const { return pairs_; }

    /// The criterion when t moves the dynamic set; m^4, 0 without pairs.
    double operator()(const Transformation2D &t) const {
        const Matrix &m = m_;
        const double c = t.cos(), s = t.sin(), x = t.x(), y = t.y();
        const double both = c * (s * m(0, 1) + x * m(0, 2) + y * m(0, 3) + m(0, 4)) +
                            s * (x * m(1, 2) + y * m(1, 3) + m(1, 4)) + x * (y * m(2, 3) + m(2, 4)) +
                            y * m(3, 4);
        const double squares =
            c * c * m(0, 0) + s * s * m(1, 1) + x * x * m(2, 2) + y * y * m(3, 3) + m(4, 4);
        return std::max(squares + 2 * both, 0.0); // rounding must not make it negative; NaN stays NaN
    }

    /// The criterion, its gradient and Hessian by (x, y, alpha).
    CriterionExpansion expansion(const Transformation2D &t) const {
        const double c = t.cos(), s = t.sin();
        Vector u;
        u << c, s, t.x(), t.y(), 1;
        Eigen::Matrix<double, 3, 5> j =
            Eigen::Matrix<double, 3, 5>::Zero(); // of u by (x, y, alpha), transposed
        j(0, 2) = j(1, 3) = 2;
        j(2, 0) = -2 * s;
        j(2, 1) = 2 * c;
        const Vector mu = product(m_, u);
        CriterionExpansion e;
        e.value = std::max(u.dot(mu), 0.0);
        e.gradient = product(j, mu);
        e.hessian = product(j, m_, j) / 2;
        e.hessian(2, 2) -= 2 * (c * mu(0) + s * mu(1)); // u itself bends by -(cos, sin)
        return e;
    }

private:
    using Matrix = Eigen::Matrix<double, 5, 5>;
    using Vector = Eigen::Matrix<double, 5, 1>;

    static Matrix matrixOf(const SegmentPair &p) {
        const Vector2D<double> a = p.fixed.begin(), b = p.fixed.end(), c = p.moving.begin(),
                               d = p.moving.end();
        const Vector2D<double> x = b - a, y = d - c, z = d + c, v = b - 3.0 * a;
        Vector g;
        g << x.cross(z), x.dot(z), -2 * x.y, 2 * x.x, x.cross(v); // (7.17)
        Matrix m = square(p.weight, g);
        const double cross = x.cross(y), dot = x.dot(y); // (7.16)
        m(0, 0) += p.weight * cross * cross;
        m(0, 1) += p.weight * cross * dot;
        m(1, 0) = m(0, 1);
        m(1, 1) += p.weight * dot * dot;
        return m;
    }
    void drop(int count) {
        pairs_ -= count;
        if (pairs_ == 0)
            clear();
    }

    Matrix m_ = Matrix::Zero();
    int pairs_ = 0;
};

} // namespace vectorlib
