#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/relations/TypedSegment.h"

#include <vector>

namespace vectorlib {

/// A local map that grows scan by scan. Pose-free thesis 5.8, Algorithm 11. Map frame: that of the first
/// scan. A segment that matches one of the scan before is merged into the map's segment of that one; another
/// that overlaps parallel map segments on its line is merged with all of them; the rest is new.
class LocalMap {
public:
    double angle = 5 * pi / 180; ///< of what counts as parallel; radians
    double distance = 0.10;      ///< and as on one line; metres

    const VectorMap &map() const { return map_; }
    void clear() {
        map_.clear();
        last_.clear();
    }
    /// Adds a scan. Pairs hold numbers of segments of the scan before (fixed) and of this one (moving); pose
    /// is that of the sensor in the map.
    void update(const std::vector<CorrespondencePair> &pairs, const std::vector<TypedSegment> &scan,
                const Transformation2D &pose);

private:
    bool isAlive(int id) const {
        return id >= 0 && map_.slots()[static_cast<std::size_t>(id)].observations > 0;
    }
    static EdgeRaw2D edgeOf(const TypedSegment &s, const Transformation2D &pose);
    // Lines 9 to 17.
    void mergePair(const CorrespondencePair &p, const std::vector<TypedSegment> &scan,
                   const Transformation2D &pose);
    // Lines 18 to 30: into the first of those that overlap it on its line, which then takes in the others.
    // Returns its number, -1 when there is none.
    int mergeOverlapping(const EdgeRaw2D &edge);

    VectorMap map_;
    std::vector<int> last_, ids_; // the map's numbers of the segments of the last scan and of this one
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/LocalMap.cpp")
