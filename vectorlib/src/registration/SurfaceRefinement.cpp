#include "vectorlib/registration/SurfaceRefinement.h"

#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/registration/PointAgreement.h"

namespace vectorlib {

VECTORLIB_BODY void SurfaceRefinement::start(const ScanSurface &fixed, const ScanSurface &moving) {
    fixed_ = &fixed.pieces();
    moving_ = &moving.pieces();
    grid_.build(*fixed_, static_cast<float>(gate));
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
