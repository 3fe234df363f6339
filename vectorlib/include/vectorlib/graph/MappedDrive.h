#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/graph/LoopCloser.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/MapReview.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/mapping/VectorMap.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace vectorlib {

/// What a drive saw, and the poses that fit all of it: makes a map anew where the drive came back to a place
/// and its poses moved.
class MappedDrive {
public:
    LoopCloser loops;
    /// Of a map that there was before the drive, in the frame of the first pose; it stays as it is.
    std::vector<MapEdge> known;

    /// Of a scan: all its edges were seen from its pose.
    static constexpr std::uint32_t all = std::numeric_limits<std::uint32_t>::max();

    /// The next scan: its points and edges in the sensor's frame (no edges of one that is in doubt), the
    /// motion since the scan before (the pose, for the first) as it was tracked, and by what; own: how many
    /// edges, the first ones, its sensor saw.
    void add(PointSpan<float> points, const std::vector<EdgeRaw2D> &edges, const Transformation2D &tracked,
             TrackedBy by, std::uint32_t own = all);
    /// Goes on with a drive that was remembered; edges and own: one a scan.
    void restore(LoopCloser::Memory memory, std::vector<std::vector<EdgeRaw2D>> edges,
                 std::vector<std::uint32_t> own = {});
    /// Memory that it takes, about, but for what is in reserve.
    std::size_t bytes() const { return loops.bytes() + edgeBytes_ + known.size() * sizeof(MapEdge); }
    /// The builder's map becomes that of all scans so far, where they are now.
    void rebuild(MapBuilder &builder) const {
        startAnew(builder);
        extend(builder, 0);
    }
    /// The same at other poses, one a scan; progress counts the scans.
    void rebuild(MapBuilder &builder, const std::vector<Pose2D> &poses,
                 const std::function<void(std::size_t done, std::size_t all)> &progress = {}) const;
    /// The builder's map takes the scans from that number on.
    void extend(MapBuilder &builder, std::size_t from) const {
        for (std::size_t i = from; i < edges_.size(); ++i)
            if (!edges_[i].empty())
                builder.place(edges_[i], loops.pose(i));
    }
    /// The same at other poses (one a scan of the drive), up to that number.
    void extend(MapBuilder &builder, const std::vector<Pose2D> &poses, std::size_t from,
                std::size_t end) const {
        for (std::size_t i = from; i < end; ++i)
            if (!edges_[i].empty())
                builder.place(edges_[i], poses[i]);
    }
    /// The loops of the graph as motions between scans.
    std::vector<PoseConstraint> loopsOfScans() const;

    /// Walls that stand twice and those that scans saw through leave the map, which was made at these poses.
    MapReviewCounts review(VectorMap &map, const std::vector<Pose2D> &poses) const {
        MapReview review;
        review.settings.known = static_cast<int>(known.size());
        return review(map, {edges_, poses, &own_});
    }
    /// Of each scan, sensor frame.
    const std::vector<std::vector<EdgeRaw2D>> &edges() const { return edges_; }
    /// How many of them its own sensor saw; may be more than there are.
    const std::vector<std::uint32_t> &own() const { return own_; }

private:
    static std::size_t bytesOf(const std::vector<EdgeRaw2D> &edges) {
        return sizeof edges + edges.capacity() * sizeof(EdgeRaw2D);
    }
    void startAnew(MapBuilder &builder) const {
        builder.clear();
        for (const MapEdge &edge : known)
            builder.map.add(edge, edge.observations);
    }

    std::vector<std::vector<EdgeRaw2D>> edges_;
    std::vector<std::uint32_t> own_;
    std::size_t edgeBytes_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/MappedDrive.cpp")
