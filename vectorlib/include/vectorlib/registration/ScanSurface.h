#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/ScanIndex.h"

#include <vector>

namespace vectorlib {

/// A short piece of the surfaces that a scan saw; sensor frame, metres.
struct SurfacePiece {
    Vector2D<float> place;
    Vector2D<float> normal; ///< of unit length, towards the sensor's side
    float direction = 0;    ///< of the normal; degrees in [0, 360)
    float length = 0;       ///< how much of the surface it stands for; metres
};

/// The surfaces of a scan in even pieces, whatever the distance they were seen from. Points lie close
/// together on near walls and far apart on distant ones; how much of two scans agrees is told by lengths of
/// wall, not by numbers of points, as from another place other walls are near. Keeps its buffers between
/// scans.
class ScanSurface {
public:
    float spacing = 0.10f;        ///< least distance of neighbouring pieces; metres
    float longest = 0.30f;        ///< no point stands for more than so much of a surface; metres
    std::size_t mostPieces = 150; ///< of a scan with more, pieces lie farther apart

    /// Takes the surfaces of a scan.
    void build(const ScanIndex &scan);
    /// Sorted by the directions of their normals. Points that stand alone have none and are left out.
    const std::vector<SurfacePiece> &pieces() const { return pieces_; }
    /// How much of a surface the point of that number in the scan's index stands for; metres.
    float lengthOf(int point) const { return lengths_[static_cast<std::size_t>(point)]; }
    /// Of all points together; metres.
    float length() const { return total_; }
    /// Half of the points are nearer to the sensor; metres.
    float medianRange() const { return medianRange_; }

private:
    // A point stands for half of the way to each of its neighbours.
    void measureLengths(const ScanIndex &scan);
    void cut(const ScanIndex &scan, float least);

    std::vector<SurfacePiece> pieces_;
    std::vector<float> lengths_; // by point
    std::vector<float> squares_; // of the ranges
    float total_ = 0, medianRange_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/ScanSurface.cpp")
