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
        : cos_(std::cos(alpha))
        , sin_(std::sin(alpha))
        , translation_(x, y) {}
    explicit Transformation2D(const Pose2D &pose)
        : Transformation2D(pose.x, pose.y, pose.theta) {}
    /// Transformation2D(twist.motion(seconds)) for one sine and one cosine: for points that each have a time.
    Transformation2D(const Twist2D &twist, double seconds) {
        const double a = twist.omega * seconds;
        const auto [s, c] = ArcFactors(a);
        cos_ = 1 - a * c;
        sin_ = a * s;
        translation_ = {(s * twist.vx - c * twist.vy) * seconds, (c * twist.vx + s * twist.vy) * seconds};
    }

    double x() const { return translation_.x; }
    double y() const { return translation_.y; }
    /// In (-pi, pi].
    double alpha() const { return std::atan2(sin_, cos_); }
    double cos() const { return cos_; }
    double sin() const { return sin_; }
    Vector2D<double> translation() const { return translation_; }
    /// The pose whose transformation this is.
    Pose2D pose() const { return {x(), y(), alpha()}; }

    /// A direction turned by alpha; it is not shifted.
    template <typename Scalar>
    Vector2D<Scalar> rotate(Vector2D<Scalar> v) const {
        return Vector2D<Scalar>(Vector2D<double>(cos_ * v.x - sin_ * v.y, sin_ * v.x + cos_ * v.y));
    }
    /// The point p, moved.
    template <typename Scalar>
    Vector2D<Scalar> operator*(Vector2D<Scalar> p) const {
        return Vector2D<Scalar>(Vector2D<double>(cos_ * p.x - sin_ * p.y + translation_.x,
                                                 sin_ * p.x + cos_ * p.y + translation_.y));
    }
    /// The segment s, moved.
    template <typename Scalar>
    LineSegment2D<Scalar> operator*(const LineSegment2D<Scalar> &s) const {
        return {*this * s.begin(), *this * s.end(), rotate(s.direction())};
    }
    /// First o, then this.
    Transformation2D operator*(const Transformation2D &o) const {
        Transformation2D r;
        r.cos_ = cos_ * o.cos_ - sin_ * o.sin_;
        r.sin_ = sin_ * o.cos_ + cos_ * o.sin_;
        const double correction = 1.5 - 0.5 * (r.cos_ * r.cos_ + r.sin_ * r.sin_); // stays a rotation
        r.cos_ *= correction;
        r.sin_ *= correction;
        r.translation_ = *this * o.translation_;
        return r;
    }
    /// The transformation that takes every moved point back.
    Transformation2D inverse() const {
        Transformation2D r;
        r.cos_ = cos_;
        r.sin_ = -sin_;
        r.translation_ = -r.rotate(translation_);
        return r;
    }
    /// Whether it shifts by more than `metres`, or turns by more than `radians`.
    bool exceeds(double metres, double radians) const {
        return translation_.norm() > metres || std::abs(alpha()) > radians;
    }
    bool isFinite() const { return translation_.isFinite() && std::isfinite(cos_) && std::isfinite(sin_); }

private:
    double cos_ = 1;
    double sin_ = 0;
    Vector2D<double> translation_;
};

} // namespace vectorlib
