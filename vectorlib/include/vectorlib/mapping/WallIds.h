#pragma once

#include "vectorlib/mapping/ScanDrive.h"
#include "vectorlib/mapping/WallFinder.h"

#include <algorithm>
#include <map>

namespace vectorlib {

/// Lets the walls of a map that was made anew keep the ids that they had: a wall is the same when most of the
/// length that scans saw of it is what they saw of the old one, and the other way round.
class WallIds {
public:
    /// The old map; `drive` at the poses by which it was made.
    void remember(const VectorMap &map, const ScanDrive &drive) {
        next_ = static_cast<std::int64_t>(map.slots().size());
        find(map, drive, old_);
    }
    /// The new map, of the same scans in the same order. Walls that are not the same as an old one get ids
    /// that no wall had.
    void keep(VectorMap &map, const ScanDrive &drive) {
        find(map, drive, new_);
        Lengths shared;
        std::size_t k = 0;
        for (const std::vector<EdgeRaw2D> &edges : drive.edges)
            for (const EdgeRaw2D &e : edges) {
                if (k < old_.size() && old_[k] >= 0 && new_[k] >= 0)
                    shared[{new_[k], old_[k]}] += e.segment.length();
                ++k;
            }
        const auto best = bestOf(shared);
        std::vector<MapEdge> walls;
        map.forEach([&](const MapEdge &e) {
            walls.push_back(e);
            const auto found = best.find(e.id);
            walls.back().id = found != best.end() ? found->second : next_++;
        });
        map.assign(walls);
    }

private:
    // What scans saw of both, by new and old wall; metres.
    using Lengths = std::map<std::pair<std::int64_t, std::int64_t>, double>;

    // The wall of every edge of the drive, one scan after the other.
    void find(const VectorMap &map, const ScanDrive &drive, std::vector<std::int64_t> &walls) {
        finder_.index(map);
        walls.clear();
        for (std::size_t i = 0; i < drive.edges.size(); ++i) {
            const Transformation2D pose(drive.poses[i]);
            for (const EdgeRaw2D &e : drive.edges[i])
                walls.push_back(finder_(pose * e.segment));
        }
    }
    // New wall and old one where each shares most with the other.
    static std::map<std::int64_t, std::int64_t> bestOf(const Lengths &shared) {
        struct Most {
            std::int64_t wall = -1;
            double length = 0;
        };
        std::map<std::int64_t, Most> ofNew, ofOld;
        const auto offer = [](Most &most, std::int64_t wall, double length) {
            if (length > most.length)
                most = {wall, length};
        };
        for (const auto &[walls, length] : shared) {
            offer(ofNew[walls.first], walls.second, length);
            offer(ofOld[walls.second], walls.first, length);
        }
        std::map<std::int64_t, std::int64_t> result;
        for (const auto &[wall, most] : ofNew)
            if (ofOld[most.wall].wall == wall)
                result[wall] = most.wall;
        return result;
    }

    WallFinder finder_;
    std::vector<std::int64_t> old_, new_;
    std::int64_t next_ = 0;
};

} // namespace vectorlib
