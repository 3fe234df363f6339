#include "vectorlib/registration/ScanSurface.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/SmallMatrix.h"

namespace vectorlib {

VECTORLIB_BODY void ScanSurface::build(const ScanIndex &scan) {
    measureLengths(scan);
    pieces_.clear();
    float least = spacing;
    do {
        cut(scan, least);
        least *= 1.5f;
    } while (pieces_.size() > maxPieces && least < 1e6f);
    if (pieces_.size() > maxPieces)
        pieces_.resize(maxPieces);
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

VECTORLIB_BODY void SurfaceAgreement::add(Scan scan, const Transformation2D &motion, const ScanIndex &other,
                                          double deviation, int sample) {
    constexpr float gate = 0.3f, beside = 0.2f, sameWay = 0.7f; // metres, metres, cosine
    const FloatMotion move(motion);
    const float inverse = static_cast<float>(1 / (4 * deviation * deviation));
    for (int i = 0; i < scan.points.size(); i += sample) {
        const Vector2D<float> p = move * scan.points.point(i), own = move.rotate(scan.points.normal(i));
        const float length = scan.surface.lengthOf(i);
        length_ += length;
        if (const int k = other.nearestAhead(p, gate * gate); k >= 0) {
            const Vector2D<float> n = other.normal(k), off = p - other.point(k);
            const bool alone = n.squaredNorm() * own.squaredNorm() < 0.5f; // without a normal
            if (alone || n.dot(own) > sameWay) {
                const float across = n.dot(off), square = off.squaredNorm();
                const float q = 1 / (1 + (alone ? square : across * across) * inverse);
                const float part = length * q * q * (square > beside * beside ? 0.5f : 1.0f);
                explained_ += part;
                walls_.add(n, part);
                continue;
            }
        }
        if (other.looksPast(p))
            contradicted_ += length;
    }
}

VECTORLIB_BODY Transformation2D SurfaceRefinement::operator()(Transformation2D pose) const {
    double width = gate;
    for (int i = 0; i < steps; ++i) {
        pose = improved(pose, width);
        width = std::max(lastGate, width * gateFactor);
    }
    return pose;
}

VECTORLIB_BODY Transformation2D SurfaceRefinement::improved(const Transformation2D &pose,
                                                            double width) const {
    const FloatMotion motion(pose);
    const float inverse = static_cast<float>(4 / (width * width)), facing = static_cast<float>(sameWay);
    float xx = 0, xy = 0, xa = 0, yy = 0, ya = 0, aa = 0, x = 0, y = 0, a = 0;
    for (const SurfacePiece &piece : *moving_) {
        const Vector2D<float> turned = motion.rotate(piece.place), p = turned + motion.translation;
        const int k = grid_.nearest(p);
        if (k < 0)
            continue;
        const SurfacePiece &wall = (*fixed_)[static_cast<std::size_t>(k)];
        const Vector2D<float> n = wall.normal;
        if (n.dot(motion.rotate(piece.normal)) < facing)
            continue;
        const float r = n.dot(p - wall.place), u = turned.cross(n);
        const float q = 1 / (1 + r * r * inverse), w = q * q; // Geman and McClure
        xx += w * n.x * n.x;
        xy += w * n.x * n.y;
        xa += w * n.x * u;
        yy += w * n.y * n.y;
        ya += w * n.y * u;
        aa += w * u * u;
        x += w * n.x * r;
        y += w * n.y * r;
        a += w * u * r;
    }
    constexpr float hold = 0.5f; // as of one piece: where nothing else does, the pose stays
    Eigen::Matrix3d h;
    h << xx + hold, xy, xa, xy, yy + hold, ya, xa, ya, aa + hold;
    const std::optional<Eigen::Vector3d> back = solveSymmetric(h, Eigen::Vector3d(x, y, a));
    if (!back)
        return pose;
    return {pose.x() - (*back)(0), pose.y() - (*back)(1), pose.alpha() - (*back)(2)};
}

} // namespace vectorlib
