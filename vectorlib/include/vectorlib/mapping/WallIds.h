#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/mapping/ScanDrive.h"
#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/mapping/WallFinder.h"

#include <cstdint>
#include <map>
#include <vector>

namespace vectorlib {

/// Lets the walls of a map that was made anew keep the ids that they had: a wall is the same when most of the
/// length that scans saw of it is what they saw of the old one, and the other way round.
class WallIds {
public:
    /// The old map; `drive` at the poses by which it was made.
    void remember(const VectorMap &map, const ScanDrive &drive);
    /// The new map, of the same scans in the same order. Walls that are not the same as an old one get ids
    /// that no wall had.
    void keep(VectorMap &map, const ScanDrive &drive);

private:
    // What scans saw of both, by new and old wall; metres.
    using Lengths = std::map<std::pair<std::int64_t, std::int64_t>, double>;

    // The wall of every edge of the drive, one scan after the other.
    void find(const VectorMap &map, const ScanDrive &drive, std::vector<std::int64_t> &walls);
    // New wall and old one where each shares most with the other.
    static std::map<std::int64_t, std::int64_t> bestOf(const Lengths &shared);

    WallFinder finder_;
    std::vector<std::int64_t> old_, new_;
    std::int64_t next_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/WallIds.cpp")
