#include "vectorlib/mapping/WallIds.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY void WallIds::remember(const VectorMap &map, const ScanDrive &drive) {
    next_ = static_cast<std::int64_t>(map.slots().size());
    find(map, drive, old_);
}

VECTORLIB_BODY void WallIds::keep(VectorMap &map, const ScanDrive &drive) {
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

VECTORLIB_BODY void WallIds::find(const VectorMap &map, const ScanDrive &drive,
                                  std::vector<std::int64_t> &walls) {
    finder_.index(map);
    walls.clear();
    for (std::size_t i = 0; i < drive.edges.size(); ++i) {
        const Transformation2D pose(drive.poses[i]);
        for (const EdgeRaw2D &e : drive.edges[i])
            walls.push_back(finder_(pose * e.segment));
    }
}

VECTORLIB_BODY std::map<std::int64_t, std::int64_t> WallIds::bestOf(const Lengths &shared) {
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

} // namespace vectorlib
