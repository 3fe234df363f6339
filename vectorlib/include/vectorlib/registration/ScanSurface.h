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
    /// Half of the surfaces are nearer to the sensor; metres.
    float medianRange() const { return medianRange_; }

private:
    void measureLengths(const ScanIndex &scan) {
        lengths_.assign(static_cast<std::size_t>(scan.size()), 0.0f);
        ranges_.clear();
        total_ = 0;
        for (int i = 0; i < scan.size(); ++i) {
            float twice = 0;
            for (int k : {i - 1, i + 1})
                if (k >= 0 && k < scan.size())
                    twice += std::min(2 * longest, (scan.point(k) - scan.point(i)).norm());
            const float length = std::min(longest, twice / 2);
            total_ += lengths_[static_cast<std::size_t>(i)] = length;
            ranges_.push_back(scan.point(i).norm());
        }
        const auto middle = ranges_.begin() + static_cast<std::ptrdiff_t>(ranges_.size() / 2);
        std::nth_element(ranges_.begin(), middle, ranges_.end());
        medianRange_ = ranges_.empty() ? 0 : *middle;
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
    std::vector<float> lengths_, ranges_;
    float total_ = 0, medianRange_ = 0;
};

} // namespace vectorlib
