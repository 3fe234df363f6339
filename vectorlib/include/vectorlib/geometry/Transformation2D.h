#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"

namespace vectorlib {

/// A rigid transformation p' = R(alpha) p + t; metres, radians. Keeps cos and sin of alpha.
/// The transformation of a pose takes points of the pose's own frame to the frame the pose is given in.
class Transformation2D {
public:
    Transformation2D() = default;
    Transformation2D(double x, double y, double alpha)
        : m_cos(std::cos(alpha))
        , m_sin(std::sin(alpha))
        , m_translation(x, y) {}
    explicit Transformation2D(const Pose2D &pose)
        : Transformation2D(pose.x, pose.y, pose.theta) {}

    double x() const { return m_translation.x; }
    double y() const { return m_translation.y; }
    /// In (-pi, pi].
    double alpha() const { return std::atan2(m_sin, m_cos); }
    double cos() const { return m_cos; }
    double sin() const { return m_sin; }
    Vector2D<double> translation() const { return m_translation; }
    Pose2D pose() const { return {x(), y(), alpha()}; }

    template <typename Scalar>
    Vector2D<Scalar> rotate(Vector2D<Scalar> v) const {
        return Vector2D<Scalar>(Vector2D<double>(m_cos * v.x - m_sin * v.y, m_sin * v.x + m_cos * v.y));
    }
    template <typename Scalar>
    Vector2D<Scalar> operator*(Vector2D<Scalar> p) const {
        return Vector2D<Scalar>(Vector2D<double>(m_cos * p.x - m_sin * p.y + m_translation.x,
                                                 m_sin * p.x + m_cos * p.y + m_translation.y));
    }
    template <typename Scalar>
    LineSegment2D<Scalar> operator*(const LineSegment2D<Scalar> &s) const {
        return {*this * s.begin(), *this * s.end(), rotate(s.direction())};
    }
    /// First o, then this.
    Transformation2D operator*(const Transformation2D &o) const {
        Transformation2D r;
        r.m_cos = m_cos * o.m_cos - m_sin * o.m_sin;
        r.m_sin = m_sin * o.m_cos + m_cos * o.m_sin;
        const double correction = 1.5 - 0.5 * (r.m_cos * r.m_cos + r.m_sin * r.m_sin); // stays a rotation
        r.m_cos *= correction;
        r.m_sin *= correction;
        r.m_translation = *this * o.m_translation;
        return r;
    }
    Transformation2D inverse() const {
        Transformation2D r;
        r.m_cos = m_cos;
        r.m_sin = -m_sin;
        r.m_translation = -r.rotate(m_translation);
        return r;
    }
    bool isFinite() const { return m_translation.isFinite() && std::isfinite(m_cos) && std::isfinite(m_sin); }

private:
    double m_cos = 1;
    double m_sin = 0;
    Vector2D<double> m_translation;
};

} // namespace vectorlib
