#pragma once

#include "vectorlib/graph/LoopCloser.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/MapReview.h"

#include <vector>

namespace vectorlib {

/// What a drive saw, and the poses that fit all of it: makes a map anew where the drive came back to a place
/// and its poses moved.
class MappedDrive {
public:
    LoopCloser loops;
    /// Of a map that there was before the drive, in the frame of the first pose; it stays as it is.
    std::vector<MapEdge> known;

    /// The next scan: its points and edges in the sensor's frame (no edges of one that is in doubt), the
    /// motion since the scan before (the pose, for the first) as it was tracked, and by what.
    void add(PointSpan<float> points, const std::vector<EdgeRaw2D> &edges, const Transformation2D &tracked,
             TrackedBy by) {
        loops.add(points, tracked, by);
        edges_.push_back(edges);
        edges_.back().shrink_to_fit();
    }
    /// The builder's map becomes that of all scans so far, where they are now.
    void rebuild(MapBuilder &builder) const {
        builder.clear();
        for (const MapEdge &edge : known)
            builder.map.add(edge, edge.observations);
        extend(builder, 0);
    }
    /// The builder's map takes the scans from that number on.
    void extend(MapBuilder &builder, std::size_t from) const {
        for (std::size_t i = from; i < edges_.size(); ++i)
            if (!edges_[i].empty())
                builder.place(edges_[i], loops.pose(i));
    }

    /// Walls that stand twice and those that scans saw through leave the map.
    MapReviewCounts review(VectorMap &map) const { return MapReview()(map, {edges_, loops.poses()}); }
    /// Of each scan, sensor frame.
    const std::vector<std::vector<EdgeRaw2D>> &edges() const { return edges_; }

private:
    std::vector<std::vector<EdgeRaw2D>> edges_;
};

} // namespace vectorlib
