#pragma once

#include "vectorlib/geometry/Vector2D.h"

#include <algorithm>

namespace vectorlib {

/// A directed line segment; metres. Free space lies on its LEFT. Keeps its unit direction.
/// A segment of no length has direction (0, 0).
template <typename Scalar = float>
class LineSegment2D {
public:
    using Vector = Vector2D<Scalar>;

    LineSegment2D() = default;
    LineSegment2D(Vector begin, Vector end)
        : begin_(begin)
        , end_(end)
        , direction_((end - begin).normalized()) {}
    /// For callers that know the unit direction from begin to end already.
    LineSegment2D(Vector begin, Vector end, Vector direction)
        : begin_(begin)
        , end_(end)
        , direction_(direction) {}
    template <typename Other>
    explicit LineSegment2D(const LineSegment2D<Other> &o)
        : LineSegment2D(Vector(o.begin()), Vector(o.end()), Vector(o.direction())) {}

    Vector begin() const { return begin_; }
    Vector end() const { return end_; }
    Vector direction() const { return direction_; }
    /// Left normal, towards free space.
    Vector normal() const { return direction_.left(); }
    Scalar length() const { return (end_ - begin_).dot(direction_); }
    Vector middle() const { return (begin_ + end_) * Scalar(0.5); }

    /// Distance along the line from begin; negative before it.
    Scalar along(Vector p) const { return (p - begin_).dot(direction_); }
    /// Signed distance from the line; positive on the left.
    Scalar across(Vector p) const { return direction_.cross(p - begin_); }
    /// Distance from the segment, ends included.
    Scalar distance(Vector p) const {
        const Scalar t = std::clamp(along(p), Scalar(0), length());
        return (p - begin_ - direction_ * t).norm();
    }
    /// Length of the part of this segment that other covers when projected onto it; 0 when apart.
    Scalar overlap(const LineSegment2D &other) const {
        const Scalar t0 = along(other.begin_), t1 = along(other.end_);
        const Scalar from = std::max(Scalar(0), std::min(t0, t1)), to = std::min(length(), std::max(t0, t1));
        return std::max(Scalar(0), to - from);
    }
    /// Mean squared distance of the points of another segment from the line.
    Scalar meanSquareAcross(const LineSegment2D &other) const {
        const Scalar a = across(other.begin_), b = across(other.end_);
        return (a * a + a * b + b * b) / 3;
    }
    /// From one distance along the line to another; before begin and beyond the end it goes on straight.
    LineSegment2D part(Scalar from, Scalar to) const {
        return {begin_ + direction_ * from, begin_ + direction_ * to, direction_};
    }
    LineSegment2D reversed() const { return {end_, begin_, -direction_}; }
    bool isFinite() const { return begin_.isFinite() && end_.isFinite(); }

private:
    Vector begin_;
    Vector end_;
    Vector direction_;
};

/// Two segments that are known to be the same edge, seen in two frames; metres.
struct SegmentPair {
    LineSegment2D<double> fixed;  ///< of the static set
    LineSegment2D<double> moving; ///< of the dynamic set
    double weight = 1;
};

/// Whether a segment has a direction and finite ends: what registration and similarity need of it.
inline bool isUsable(const LineSegment2D<double> &s) {
    return s.isFinite() && s.direction().squaredNorm() > 0.5; // not so for a zero or NaN direction
}

/// Whether both segments are usable and the weight is a finite number above 0.
inline bool isUsable(const SegmentPair &p) {
    return isUsable(p.fixed) && isUsable(p.moving) && p.weight > 0 && std::isfinite(p.weight);
}

/// The line ax + by + c = 0 with a unit normal (a, b); metres. Thesis eqs. (6.5), (6.6).
/// Fits from a scanner at the origin have c >= 0: the normal points to the scanner, that is to free space.
struct Line2D {
    double a = 0;
    double b = 0;
    double c = 0;

    /// False for the default line, which has no direction (isotropic or empty data).
    bool isValid() const { return a != 0 || b != 0; }
    /// Distance of a point from the line, positive on the side to which the normal points; metres.
    double signedDistance(Vector2D<double> p) const { return a * p.x + b * p.y + c; }
    /// (a, b).
    Vector2D<double> normal() const { return {a, b}; }
    /// The direction whose left normal is (a, b).
    Vector2D<double> direction() const { return {b, -a}; }
    /// The point of the line that is nearest to p.
    Vector2D<double> project(Vector2D<double> p) const { return p - normal() * signedDistance(p); }
};

/// Where two lines cross; false (and the point untouched) when they are parallel.
inline bool intersect(const Line2D &l, const Line2D &m, Vector2D<double> &point) {
    const double det = l.a * m.b - m.a * l.b;
    if (std::abs(det) < 1e-12)
        return false;
    point = {(l.b * m.c - m.b * l.c) / det, (m.a * l.c - l.a * m.c) / det};
    return true;
}

} // namespace vectorlib
