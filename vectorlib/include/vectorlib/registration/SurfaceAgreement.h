#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/PointAgreement.h"
#include "vectorlib/registration/ScanIndex.h"
#include "vectorlib/registration/ScanSurface.h"

namespace vectorlib {

/// How much of the surfaces of two scans lies on each other, as lengths: a stretch of wall counts the same
/// whether it was seen by many points from nearby or by few from afar.
class SurfaceAgreement {
public:
    /// A scan's points and the lengths that they stand for.
    struct Scan {
        const ScanIndex &points;
        const ScanSurface &surface;
    };

    SurfaceAgreement() = default;
    /// Judges every n-th point of both scans when the moving one lies at the pose. A point `deviation` metres
    /// from the other scan's wall, along the normal, is explained to two thirds of its length.
    SurfaceAgreement(Scan fixed, Scan moving, const Transformation2D &pose, double deviation, int sample);
    /// Of all that was judged; metres.
    double length() const { return length_; }
    /// Share that has something of the other scan beside it.
    double explained() const { return length_ > 0 ? explained_ / length_ : 0; }
    /// Share at whose place the other scan saw through.
    double contradicted() const { return length_ > 0 ? contradicted_ / length_ : 0; }
    /// In [-1, 1]; 1 is perfect: explained less contradicted length, as a share of both and of half of what
    /// is out of the other scan's sight.
    double score() const { return balance(0.5); }
    /// The same with little weight, 0.15, on what is out of sight: the other scan says nothing of it. Two
    /// motions that fit alike what both scans could see are about equal, unless one hardly overlaps.
    double consistency() const { return balance(0.15); }
    /// In [0, 1], of the directions of what is explained as that of lines (paper (28)): small along a
    /// corridor.
    double reliability() const;
    /// The direction in which the scans slide on each other most easily; fixed frame, unit length.
    Vector2D<double> openDirection() const;

private:
    // What is out of sight weighs `hidden` of its length.
    double balance(double hidden) const;
    void add(Scan scan, const Transformation2D &motion, const ScanIndex &other, double deviation, int sample);
    // The sums over the normals, from the moving frame to the fixed one.
    void turnDirections(const Transformation2D &pose);

    double length_ = 0, explained_ = 0, contradicted_ = 0;
    double xx_ = 0, xy_ = 0, yy_ = 0; // sums over the normals
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/SurfaceAgreement.cpp")
