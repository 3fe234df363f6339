#include "vectorlib/graph/MappedDrive.h"

#include <utility>

namespace vectorlib {

VECTORLIB_BODY void MappedDrive::add(PointSpan<float> points, const std::vector<EdgeRaw2D> &edges,
                                     const Transformation2D &tracked, TrackedBy by, std::uint32_t own) {
    loops.add(points, tracked, by);
    edges_.push_back(edges);
    edges_.back().shrink_to_fit();
    own_.push_back(own);
    edgeBytes_ += bytesOf(edges_.back());
}

VECTORLIB_BODY void MappedDrive::restore(LoopCloser::Memory memory, std::vector<std::vector<EdgeRaw2D>> edges,
                                         std::vector<std::uint32_t> own) {
    loops.restore(std::move(memory));
    edges_ = std::move(edges);
    own_ = std::move(own);
    own_.resize(edges_.size(), all);
    edgeBytes_ = 0;
    for (const std::vector<EdgeRaw2D> &scan : edges_)
        edgeBytes_ += bytesOf(scan);
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

} // namespace vectorlib
