#pragma once

#include "gui/vector/MapSource.h"
#include "vectorlib/graph/LoopCloser.h"
#include "vectorlib/io/Tum.h"
#include "vectorlib/mapping/MapReview.h"
#include "vectorlib/mapping/ScanTracker.h"

#include <nlohmann/json.hpp>

namespace hermes::vector {

/// Builds a map from scans and keeps account of it.
class MapRun {
public:
    vectorlib::ScanTracker tracker;
    bool closesLoops = true;

    /// A partial scan is counted and left out.
    void take(MapScan &scan);
    /// After the last scan, unless it is told not to close loops: closes them, makes the map anew from all
    /// edges where that moved the poses (a wall keeps its id), and reviews it. `progress` is told how many of
    /// how many scans are done.
    void finish(const std::function<void(std::size_t, std::size_t)> &progress);

    const std::vector<vectorlib::StampedPose> &trajectory() const { return trajectory_; }
    /// Reference poses, one a pose of the trajectory; empty without reference.
    const std::vector<vectorlib::StampedPose> &reference() const { return reference_; }
    /// The poses and the motions between them; without poses when loops were not to be closed.
    const vectorlib::PoseGraph &graph() const { return loops_.graph(); }
    std::vector<vectorlib::MapEdge> segments() const;
    /// Counts, milliseconds a scan, walls that are there twice and, with a reference, the errors against it.
    nlohmann::ordered_json summary() const;

private:
    nlohmann::ordered_json errors() const;
    nlohmann::ordered_json twins() const;
    void rebuild();
    std::vector<vectorlib::Pose2D> poses() const;

    vectorlib::LoopCloser loops_;
    vectorlib::LoopCounts closures_;
    double closeSeconds_ = 0;
    vectorlib::MapReviewCounts reviewed_;
    double reviewSeconds_ = 0;
    std::vector<std::vector<vectorlib::EdgeRaw2D>> edges_; // of each scan, sensor frame; none of one in doubt
    std::vector<vectorlib::StampedPose> trajectory_;
    std::vector<vectorlib::StampedPose> reference_;
    std::size_t partial_ = 0;
};

} // namespace hermes::vector
