#include "vectorlib/registration/SurfaceGrid.h"

namespace vectorlib {

VECTORLIB_BODY void SurfaceGrid::build(const std::vector<SurfacePiece> &pieces, float reach) {
    layOver(pieces, reach);
    nearest_.assign(cells * cells, -1);
    squares_.assign(cells * cells, reach * reach);
    const int around = static_cast<int>(std::ceil(reach * inverse_));
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Vector2D<float> p = (pieces[i].place - corner_) * inverse_; // in cells
        const int cx = static_cast<int>(p.x), cy = static_cast<int>(p.y);
        const int left = std::max(0, cx - around), right = std::min(cells - 1, cx + around);
        for (int y = std::max(0, cy - around); y <= std::min(cells - 1, cy + around); ++y) {
            const float dy = (static_cast<float>(y) + 0.5f - p.y) * cell_;
            for (int x = left; x <= right; ++x) {
                const float dx = (static_cast<float>(x) + 0.5f - p.x) * cell_;
                const std::size_t at = static_cast<std::size_t>(y * cells + x);
                if (const float d = dx * dx + dy * dy; d < squares_[at]) {
                    squares_[at] = d;
                    nearest_[at] = static_cast<std::int16_t>(i);
                }
            }
        }
    }
}

VECTORLIB_BODY int SurfaceGrid::nearest(Vector2D<float> p) const {
    const float x = (p.x - corner_.x) * inverse_, y = (p.y - corner_.y) * inverse_;
    if (!(x >= 0 && y >= 0 && x < cells && y < cells))
        return -1;
    return nearest_[static_cast<std::size_t>(static_cast<int>(y) * cells + static_cast<int>(x))];
}

VECTORLIB_BODY void SurfaceGrid::layOver(const std::vector<SurfacePiece> &pieces, float reach) {
    Vector2D<float> low, high;
    for (const SurfacePiece &piece : pieces) {
        low = {std::min(low.x, piece.place.x), std::min(low.y, piece.place.y)};
        high = {std::max(high.x, piece.place.x), std::max(high.y, piece.place.y)};
    }
    const float side = std::max(high.x - low.x, high.y - low.y) + 2 * reach;
    cell_ = std::max(least, side / cells);
    inverse_ = 1 / cell_;
    const float half = cell_ * cells / 2;
    corner_ = (low + high) * 0.5f - Vector2D<float>(half, half);
}

} // namespace vectorlib
