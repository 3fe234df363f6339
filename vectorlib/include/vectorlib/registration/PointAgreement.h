#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/registration/ScanIndex.h"

namespace vectorlib {

/// A rigid transformation in the scalars of points, for loops over many of them.
struct FloatMotion {
    float cos, sin;
    Vector2D<float> translation;

    explicit FloatMotion(const Transformation2D &t)
        : cos(static_cast<float>(t.cos()))
        , sin(static_cast<float>(t.sin()))
        , translation(t.translation()) {}
    /// A direction, turned.
    Vector2D<float> rotate(Vector2D<float> v) const { return {cos * v.x - sin * v.y, sin * v.x + cos * v.y}; }
    /// A point, moved.
    Vector2D<float> operator*(Vector2D<float> p) const { return rotate(p) + translation; }
};

/// How well the points of two scans lie on each other.
class PointAgreement {
public:
    /// Judges every n-th of the points, moved into the frame of the other scan.
    void add(const ScanIndex &points, const Transformation2D &motion, const ScanIndex &other, double gate,
             int sample) {
        const FloatMotion move(motion);
        const float squaredGate = static_cast<float>(gate * gate);
        for (int i = 0; i < points.size(); i += sample) {
            const Vector2D<float> p = move * points.point(i);
            ++points_;
            if (const int k = other.nearestAhead(p, squaredGate); k >= 0) {
                const Vector2D<float> n = other.normal(k);
                const float d = n.dot(p - other.point(k));
                ++explained_;
                distances_ += d * d / squaredGate;
                xx_ += n.x * n.x;
                xy_ += n.x * n.y;
                yy_ += n.y * n.y;
            } else if (other.looksPast(p))
                ++contradicted_;
        }
    }
    /// How many points have one of the other scan beside them.
    double explainedPoints() const { return explained_; }
    /// Share of the points with one of the other scan beside them.
    double explained() const { return points_ > 0 ? explained_ / points_ : 0; }
    /// Of the points that can be judged, the share where the other scan saw something farther away. Points
    /// outside its view or behind what it saw cannot be judged.
    double contradicted() const {
        const double judged = explained_ + contradicted_;
        return judged > 0 ? contradicted_ / judged : 0;
    }
    /// Share of all points where the other scan saw something farther away.
    double contradictedOfAll() const { return points_ > 0 ? contradicted_ / points_ : 0; }
    /// In [-1, 1]: explained less contradicted points, and less the farther apart they are; 1 is perfect.
    double score() const { return points_ > 0 ? (explained_ - distances_ - contradicted_) / points_ : 0; }
    /// In [0, 1], of the walls' directions as that of lines (paper (28)): small along a corridor.
    double reliability() const {
        const double sum = xx_ + yy_;
        return sum > 0 ? 2 * std::sqrt(std::max(0.0, xx_ * yy_ - xy_ * xy_)) / sum : 0;
    }

private:
    double points_ = 0, explained_ = 0, contradicted_ = 0;
    double distances_ = 0;            // squared, in units of the gate
    double xx_ = 0, xy_ = 0, yy_ = 0; // sums over the walls' normals
};

} // namespace vectorlib
