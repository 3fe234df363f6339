#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/ScanSurface.h"
#include "vectorlib/registration/SurfaceGrid.h"

#include <vector>

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
    void start(const ScanSurface &fixed, const ScanSurface &moving);
    /// The transformation of the moving scan onto the fixed one, from one nearby.
    Transformation2D operator()(Transformation2D pose) const;

private:
    Transformation2D improved(const Transformation2D &pose, double width) const;

    const std::vector<SurfacePiece> *fixed_ = nullptr, *moving_ = nullptr;
    SurfaceGrid grid_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/SurfaceRefinement.cpp")
