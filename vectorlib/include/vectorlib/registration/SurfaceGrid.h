#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/ScanSurface.h"

#include <cstdint>
#include <vector>

namespace vectorlib {

/// The pieces of a scan's surfaces by place: which one is nearest, for any place within reach of them, at the
/// cost of one look-up. A square grid of fixed size; its cells grow with the scan. Keeps its buffers between
/// scans.
class SurfaceGrid {
public:
    /// Places farther than `reach` from every piece have none; metres.
    void build(const std::vector<SurfacePiece> &pieces, float reach);
    /// The number of the piece that lies nearest, to a cell; -1 where none is within reach.
    int nearest(Vector2D<float> p) const;

private:
    static constexpr int cells = 128; // to a side
    static constexpr float least = 0.15f;

    void layOver(const std::vector<SurfacePiece> &pieces, float reach);

    Vector2D<float> corner_;
    float cell_ = least, inverse_ = 1 / least;
    std::vector<std::int16_t> nearest_;
    std::vector<float> squares_; // of the distances to the nearest
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/SurfaceGrid.cpp")
