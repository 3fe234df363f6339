#pragma once

#include "gui/vector/MapSource.h"
#include "gui/vector/Options.h"
#include "vectorlib/io/Tum.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/MapEdge.h"
#include "vectorlib/mapping/MotionModel.h"

#include <nlohmann/json.hpp>

namespace hermes {

/// Builds a map from scans and keeps account of it.
class MapRun {
public:
    vectorlib::MapBuilder builder;
    SegmentOptions segmentation; ///< over the defaults of each scan's scanner
    bool useOdometry = true;     ///< where a scan has any; else the motion is expected to go on as before

    void take(const MapScan &scan);

    const std::vector<vectorlib::StampedPose> &trajectory() const { return trajectory_; }
    /// Reference poses, one a pose of the trajectory; empty without reference.
    const std::vector<vectorlib::StampedPose> &reference() const { return reference_; }
    std::vector<vectorlib::MapEdge> segments() const;
    /// Counts, milliseconds a scan and, with a reference, the errors against it.
    nlohmann::ordered_json summary() const;

private:
    bool isWellExpected(const MapScan &scan, double stamp) const;
    vectorlib::Pose2D expectedPose(const MapScan &scan, double stamp) const;
    nlohmann::ordered_json errors() const;

    vectorlib::MotionModel motion_;
    std::vector<vectorlib::StampedPose> trajectory_;
    std::vector<vectorlib::StampedPose> reference_;
    std::vector<vectorlib::Vector2D<float>> points_;
    std::size_t matched_ = 0, lost_ = 0, skipped_ = 0;
    double segmentMs_ = 0, vectorizeMs_ = 0, matchMs_ = 0, mapMs_ = 0;
};

} // namespace hermes
