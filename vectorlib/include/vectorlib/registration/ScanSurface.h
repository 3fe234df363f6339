#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/registration/ScanIndex.h"

#include <algorithm>
#include <cmath>
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
    void build(const ScanIndex &scan) {
        measureLengths(scan);
        pieces_.clear();
        float least = spacing;
        do {
            cut(scan, least);
            least *= 1.5f;
        } while (pieces_.size() > mostPieces && least < 1e6f);
        if (pieces_.size() > mostPieces)
            pieces_.resize(mostPieces);
        std::sort(pieces_.begin(), pieces_.end(),
                  [](const SurfacePiece &a, const SurfacePiece &b) { return a.direction < b.direction; });
    }
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
    void measureLengths(const ScanIndex &scan) {
        const std::size_t size = static_cast<std::size_t>(scan.size());
        lengths_.assign(size, 0.0f);
        squares_.resize(size);
        for (int i = 0; i < scan.size(); ++i) {
            squares_[static_cast<std::size_t>(i)] = scan.point(i).squaredNorm();
            if (i == 0)
                continue;
            const float half = std::min(longest, (scan.point(i) - scan.point(i - 1)).norm() / 2);
            lengths_[static_cast<std::size_t>(i - 1)] += half;
            lengths_[static_cast<std::size_t>(i)] += half;
        }
        total_ = 0;
        for (float &length : lengths_)
            total_ += length = std::min(length, longest);
        const auto middle = squares_.begin() + static_cast<std::ptrdiff_t>(size / 2);
        std::nth_element(squares_.begin(), middle, squares_.end());
        medianRange_ = size > 0 ? std::sqrt(*middle) : 0;
    }
    void cut(const ScanIndex &scan, float least) {
        pieces_.clear();
        Vector2D<float> last(1e9f, 1e9f);
        for (int i = 0; i < scan.size(); ++i) {
            const Vector2D<float> place = scan.point(i), normal = scan.normal(i);
            if (normal.squaredNorm() < 0.5f || (place - last).squaredNorm() < least * least)
                continue;
            last = place;
            const float degrees = std::atan2(normal.y, normal.x) * static_cast<float>(180 / pi);
            const float direction = degrees < 0 ? degrees + 360 : degrees;
            pieces_.push_back({place, normal, direction < 360 ? direction : 0,
                               std::max(lengthOf(i), std::min(least, longest))});
        }
    }

    std::vector<SurfacePiece> pieces_;
    std::vector<float> lengths_; // by point
    std::vector<float> squares_; // of the ranges
    float total_ = 0, medianRange_ = 0;
};

} // namespace vectorlib
