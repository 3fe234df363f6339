#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/ScanIndex.h"

namespace vectorlib {

/// A rigid transformation in the scalars of points, for loops over many of them.
struct FloatMotion {
    float cos, sin;
    Vector2D<float> translation;

    explicit FloatMotion(const Transformation2D &t);
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
             int sample);
    /// How many points have one of the other scan beside them.
    double explainedPoints() const { return explained_; }
    /// Share of the points with one of the other scan beside them.
    double explained() const { return points_ > 0 ? explained_ / points_ : 0; }
    /// Of the points that can be judged, the share where the other scan saw something farther away. Points
    /// outside its view or behind what it saw cannot be judged.
    double contradicted() const;
    /// Share of all points where the other scan saw something farther away.
    double contradictedOfAll() const { return points_ > 0 ? contradicted_ / points_ : 0; }
    /// In [-1, 1]: explained less contradicted points, and less the farther apart they are; 1 is perfect.
    double score() const { return points_ > 0 ? (explained_ - distances_ - contradicted_) / points_ : 0; }
    /// In [0, 1], of the walls' directions as that of lines (paper (28)): small along a corridor.
    double reliability() const;

private:
    double points_ = 0, explained_ = 0, contradicted_ = 0;
    double distances_ = 0;            // squared, in units of the gate
    double xx_ = 0, xy_ = 0, yy_ = 0; // sums over the walls' normals
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/PointAgreement.cpp")
