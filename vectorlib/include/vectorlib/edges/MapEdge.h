#pragma once

#include "vectorlib/edges/EdgeRaw2D.h"

#include <cstdint>

namespace vectorlib {

/// An edge of a map: all points ever seen on it by their sums (map frame), the segment they make, and how
/// often it was seen.
struct MapEdge : EdgeRaw2D {
    std::int64_t id = 0;           ///< its number in the map; no other edge has it
    std::int64_t observations = 0; ///< scans that saw it; 0 when it was merged into another

    MapEdge() = default;
    MapEdge(std::int64_t id_, const EdgeRaw2D &edge, std::int64_t observations_)
        : EdgeRaw2D(edge)
        , id(id_)
        , observations(observations_) {}
};

} // namespace vectorlib
