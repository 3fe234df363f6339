#pragma once

#include "gui/vector/MapSource.h"
#include "vectorlib/graph/DriveRefiner.h"
#include "vectorlib/graph/MappedDrive.h"
#include "vectorlib/io/Tum.h"
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
    /// After the last scan: where loops were closed, moves and refines the poses and makes the map anew from
    /// all edges.
    void finish();

    const std::vector<vectorlib::StampedPose> &trajectory() const { return trajectory_; }
    /// Reference poses, one a pose of the trajectory; empty without reference.
    const std::vector<vectorlib::StampedPose> &reference() const { return reference_; }
    /// The key scans' poses as loops were closed, not yet refined, and the motions between them; without
    /// poses when loops were not to be closed.
    const vectorlib::PoseGraph &graph() const { return drive_.loops.graph(); }
    std::vector<vectorlib::MapEdge> segments() const;
    /// Counts, milliseconds a scan and, with a reference, the errors against it.
    nlohmann::ordered_json summary() const;

private:
    nlohmann::ordered_json errors() const;
    void remember(const MapScan &scan, const vectorlib::ScanReport &report);

    vectorlib::MappedDrive drive_;
    vectorlib::DriveRefiner refine_;
    double closeSeconds_ = 0;
    std::vector<vectorlib::StampedPose> trajectory_;
    std::vector<vectorlib::StampedPose> reference_;
    std::size_t partial_ = 0;
};

} // namespace hermes::vector
