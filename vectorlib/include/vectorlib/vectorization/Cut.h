#pragma once

#include "vectorlib/vectorization/SumRow.h"

#include <cstddef>

namespace vectorlib {

/// Where one interval of points ends and the next begins, and the sums of all points before.
struct Cut {
    std::size_t index;
    SumRow row;
};

/// The sums of the points between two cuts, whose rows are in the frame of `origin`.
inline TlsSums sumsBetween(const Cut &first, const Cut &end, Vector2D<double> origin) {
    const SumRow s = end.row - first.row;
    return TlsSums::fromPlain(static_cast<double>(end.index - first.index), s.x, s.y, s.xx, s.xy, s.yy,
                              origin);
}

} // namespace vectorlib
