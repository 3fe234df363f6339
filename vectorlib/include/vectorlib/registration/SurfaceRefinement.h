#pragma once

#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/registration/PointAgreement.h"
#include "vectorlib/registration/SurfaceGrid.h"

namespace vectorlib {

/// Brings the surfaces of a scan onto those of another from half a metre and a few degrees away, roughly and
/// fast: a few Gauss-Newton steps on the distances of the moving pieces along the normals of those nearest to
/// them, while the gate narrows. Pieces pair only when they face the same way.
class SurfaceRefinement {
public:
    double gate = 0.6;       ///< the first; pieces farther apart along the normal hardly count; metres
    double lastGate = 0.15;  ///< metres
    double gateFactor = 0.6; ///< from step to step
    int steps = 4;
    double sameWay = 0.7; ///< cosine of the most between two normals

    /// Takes the surfaces of two scans, each in its sensor's frame; they must outlive the calls that follow.
    void start(const ScanSurface &fixed, const ScanSurface &moving) {
        fixed_ = &fixed.pieces();
        moving_ = &moving.pieces();
        grid_.build(*fixed_, static_cast<float>(gate));
    }
    /// The transformation of the moving scan onto the fixed one, from one nearby.
    Transformation2D operator()(Transformation2D pose) const {
        double width = gate;
        for (int i = 0; i < steps; ++i) {
            pose = improved(pose, width);
            width = std::max(lastGate, width * gateFactor);
        }
        return pose;
    }

private:
    Transformation2D improved(const Transformation2D &pose, double width) const {
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

    const std::vector<SurfacePiece> *fixed_ = nullptr, *moving_ = nullptr;
    SurfaceGrid grid_;
};

} // namespace vectorlib
