#pragma once

#include "vectorlib/correspondence/Match.h"
#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/relations/TypedSegment.h"

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
                const Transformation2D &pose) {
        ids_.assign(scan.size(), -1);
        for (const CorrespondencePair &p : pairs)
            mergePair(p, scan, pose);
        for (std::size_t i = 0; i < scan.size(); ++i)
            if (ids_[i] < 0)
                ids_[i] = mergeOverlapping(edgeOf(scan[i], pose));
        for (std::size_t i = 0; i < scan.size(); ++i)
            if (ids_[i] < 0 && isUsable(scan[i].segment))
                ids_[i] = map_.add(edgeOf(scan[i], pose));
        last_ = ids_;
    }

private:
    bool isAlive(int id) const {
        return id >= 0 && map_.slots()[static_cast<std::size_t>(id)].observations > 0;
    }
    static EdgeRaw2D edgeOf(const TypedSegment &s, const Transformation2D &pose) {
        EdgeRaw2D edge(s.sums, s.segment, 0);
        if (s.sums.n == 0) { // as of its two ends
            const Vector2D<double> ends[] = {s.segment.begin(), s.segment.end()};
            edge.sums = TlsSums::of(std::begin(ends), std::end(ends));
        }
        return pose * edge;
    }
    // Lines 9 to 17.
    void mergePair(const CorrespondencePair &p, const std::vector<TypedSegment> &scan,
                   const Transformation2D &pose) {
        const auto before = static_cast<std::size_t>(p.fixed), now = static_cast<std::size_t>(p.moving);
        if (before >= last_.size() || now >= scan.size() || !isAlive(last_[before]))
            return;
        if (map_.merge(last_[before], edgeOf(scan[now], pose)))
            ids_[now] = last_[before];
    }
    // Lines 18 to 30: into the first of those that overlap it on its line, which then takes in the others.
    // Returns its number, -1 when there is none.
    int mergeOverlapping(const EdgeRaw2D &edge) {
        const LineSegment2D<double> &s = edge.segment;
        if (!isUsable(s))
            return -1;
        const Vector2D<double> a = s.begin(), b = s.end();
        const double d = distance;
        for (int id : map_.near({std::min(a.x, b.x) - d, std::min(a.y, b.y) - d},
                                {std::max(a.x, b.x) + d, std::max(a.y, b.y) + d})) {
            const LineSegment2D<double> &m = map_.slots()[static_cast<std::size_t>(id)].segment;
            if (m.direction().dot(s.direction()) >= std::cos(angle) && m.overlap(s) > 0 &&
                std::abs(m.length() < s.length() ? s.across(m.middle()) : m.across(s.middle())) <= d &&
                map_.merge(id, edge)) {
                map_.consolidate(id);
                return id;
            }
        }
        return -1;
    }

    VectorMap map_;
    std::vector<int> last_, ids_; // the map's numbers of the segments of the last scan and of this one
};

} // namespace vectorlib
