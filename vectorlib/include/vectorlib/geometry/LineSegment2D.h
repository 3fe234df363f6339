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
        : m_begin(begin)
        , m_end(end)
        , m_direction((end - begin).normalized()) {}
    /// For callers that know the unit direction from begin to end already.
    LineSegment2D(Vector begin, Vector end, Vector direction)
        : m_begin(begin)
        , m_end(end)
        , m_direction(direction) {}
    template <typename Other>
    explicit LineSegment2D(const LineSegment2D<Other> &o)
        : LineSegment2D(Vector(o.begin()), Vector(o.end()), Vector(o.direction())) {}

    Vector begin() const { return m_begin; }
    Vector end() const { return m_end; }
    Vector direction() const { return m_direction; }
    /// Left normal, towards free space.
    Vector normal() const { return m_direction.left(); }
    Scalar length() const { return (m_end - m_begin).dot(m_direction); }
    Vector middle() const { return (m_begin + m_end) * Scalar(0.5); }

    /// Distance along the line from begin; negative before it.
    Scalar along(Vector p) const { return (p - m_begin).dot(m_direction); }
    /// Signed distance from the line; positive on the left.
    Scalar across(Vector p) const { return m_direction.cross(p - m_begin); }
    /// Distance from the segment, ends included.
    Scalar distance(Vector p) const {
        const Scalar t = std::clamp(along(p), Scalar(0), length());
        return (p - m_begin - m_direction * t).norm();
    }
    /// Length of the part of this segment that other covers when projected onto it; 0 when apart.
    Scalar overlap(const LineSegment2D &other) const {
        const Scalar t0 = along(other.m_begin), t1 = along(other.m_end);
        const Scalar from = std::max(Scalar(0), std::min(t0, t1)), to = std::min(length(), std::max(t0, t1));
        return std::max(Scalar(0), to - from);
    }
    LineSegment2D reversed() const { return {m_end, m_begin, -m_direction}; }
    bool isFinite() const { return m_begin.isFinite() && m_end.isFinite(); }

private:
    Vector m_begin;
    Vector m_end;
    Vector m_direction;
};

} // namespace vectorlib
