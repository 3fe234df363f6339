#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Vector2D.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace vectorlib {

/// When VectorMap makes one edge of several.
struct VectorMapSettings {
    double maxSigma = 0.05; ///< edges are merged only while the points stay within this of one line; metres
    double joinDistance =
        0.06;                ///< collinear edges join when their lines are no farther apart than this; metres
    double joinAngle = 0.06; ///< and no more turned than this; radians
    double joinGap = 0.10;   ///< and their ends no farther apart than this along the line; metres
};

/// A map of line segments that grows by merging: a matched edge of a scan is added to its map edge by its
/// transformed sums, so that the line is the exact total least squares line of all points ever seen on it.
/// Map frame: metres.
class VectorMap {
public:
    VectorMapSettings settings;

    /// The edges; those of observations == 0 were merged into others and are to be skipped.
    const std::vector<MapEdge> &slots() const { return edges_; }
    std::size_t size() const { return alive_; }
    bool isEmpty() const { return alive_ == 0; }
    void clear();

    /// Calls take(edge) for every edge of the map.
    template <typename Take>
    void forEach(Take take) const {
        for (const MapEdge &e : edges_)
            if (e.observations > 0)
                take(e);
    }
    /// Numbers of the edges near a box; sorted by number, so that results do not depend on hashing.
    const std::vector<int> &near(Vector2D<double> low, Vector2D<double> high) { return find(low, high); }

    /// The same of those that may lie within `margin` (metres) of a segment.
    const std::vector<int> &near(const LineSegment2D<double> &segment, double margin) {
        return find(segment, margin);
    }

    /// Adds an edge seen for the first time (or read from a file); returns its number.
    int add(const EdgeRaw2D &edge, std::int64_t observations = 1);
    /// Merges an edge (map frame) into the map's edge of that number; false, and nothing changed, when the
    /// points would no longer lie within maxSigma of one line, or another edge has taken that one in.
    bool merge(int number, const EdgeRaw2D &edge, std::int64_t observations = 1);
    /// Joins the edge with others that lie on the same line and touch it; returns how many it took in.
    int consolidate(int number);
    /// Takes another edge in, wherever it lies: by its sums, or, where the points would no longer lie within
    /// maxSigma of one line, only by how far it reaches along this one's. `observations` are those of the
    /// wall that both are.
    void absorb(int number, int other, std::int64_t observations);
    /// Holds these edges instead, each under its own id; no two have one, and none is below 0.
    void assign(const std::vector<MapEdge> &edges);
    /// Other ends on the same line; the sums stay.
    void reshape(int number, const LineSegment2D<double> &segment);
    /// Another edge on the same wall; id and observations stay.
    void replace(int number, const EdgeRaw2D &edge);
    /// Takes the edge of that number out of the map; its slot stays.
    void remove(int number) {
        edges_[static_cast<std::size_t>(number)].observations = 0;
        --alive_;
        changed_.push_back(number);
    }
    /// Numbers of edges that were added, merged or removed since the last call, for those who send changes.
    std::vector<int> takeChanges() {
        std::sort(changed_.begin(), changed_.end());
        changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
        return std::exchange(changed_, {});
    }

private:
    template <typename Place, typename Size>
    const std::vector<int> &find(const Place &place, const Size &size);
    bool join(int number, int other);
    void take(MapEdge &edge, const EdgeRaw2D &joint, std::int64_t observations);

    std::vector<MapEdge> edges_; // by number; an id is never used again
    SegmentGrid grid_;
    std::size_t alive_ = 0;
    std::vector<int> found_;
    std::vector<int> changed_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/VectorMap.cpp")
