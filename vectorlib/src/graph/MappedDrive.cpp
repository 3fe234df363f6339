#include "vectorlib/graph/MappedDrive.h"

#include <utility>

namespace vectorlib {

VECTORLIB_BODY void MappedDrive::add(PointSpan<float> points, const std::vector<EdgeRaw2D> &edges,
                                     const Transformation2D &tracked, TrackedBy by) {
    loops.add(points, tracked, by);
    edges_.push_back(edges);
    edges_.back().shrink_to_fit();
    edgeBytes_ += bytesOf(edges_.back());
}

VECTORLIB_BODY void MappedDrive::restore(LoopCloser::Memory memory,
                                         std::vector<std::vector<EdgeRaw2D>> edges) {
    loops.restore(std::move(memory));
    edges_ = std::move(edges);
    edgeBytes_ = 0;
    for (const std::vector<EdgeRaw2D> &scan : edges_)
        edgeBytes_ += bytesOf(scan);
}

VECTORLIB_BODY void MappedDrive::rebuild(MapBuilder &builder) const {
    startAnew(builder);
    extend(builder, 0);
}

VECTORLIB_BODY void
MappedDrive::rebuild(MapBuilder &builder, const std::vector<Pose2D> &poses,
                     const std::function<void(std::size_t done, std::size_t all)> &progress) const {
    startAnew(builder);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        extend(builder, poses, i, i + 1);
        if (progress)
            progress(i + 1, edges_.size());
    }
}

VECTORLIB_BODY void MappedDrive::extend(MapBuilder &builder, std::size_t from) const {
    for (std::size_t i = from; i < edges_.size(); ++i)
        if (!edges_[i].empty())
            builder.place(edges_[i], loops.pose(i));
}

VECTORLIB_BODY void MappedDrive::extend(MapBuilder &builder, const std::vector<Pose2D> &poses,
                                        std::size_t from, std::size_t end) const {
    for (std::size_t i = from; i < end; ++i)
        if (!edges_[i].empty())
            builder.place(edges_[i], poses[i]);
}

VECTORLIB_BODY std::vector<PoseConstraint> MappedDrive::loopsOfScans() const {
    std::vector<PoseConstraint> result;
    for (PoseConstraint c : loops.graph().constraints)
        if (c.mayBeWrong) {
            c.from = loops.scanOf(c.from);
            c.to = loops.scanOf(c.to);
            result.push_back(c);
        }
    return result;
}

VECTORLIB_BODY MapReviewCounts MappedDrive::review(VectorMap &map, const std::vector<Pose2D> &poses) const {
    MapReview review;
    review.settings.known = static_cast<int>(known.size());
    return review(map, {edges_, poses});
}

VECTORLIB_BODY void MappedDrive::startAnew(MapBuilder &builder) const {
    builder.clear();
    for (const MapEdge &edge : known)
        builder.map.add(edge, edge.observations);
}

} // namespace vectorlib
