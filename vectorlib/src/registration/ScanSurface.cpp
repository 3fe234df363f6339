#include "vectorlib/registration/ScanSurface.h"

#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY void ScanSurface::build(const ScanIndex &scan) {
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

VECTORLIB_BODY void ScanSurface::measureLengths(const ScanIndex &scan) {
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

VECTORLIB_BODY void ScanSurface::cut(const ScanIndex &scan, float least) {
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

} // namespace vectorlib
