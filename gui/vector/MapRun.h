#pragma once

#include "gui/vector/MapSource.h"
#include "gui/vector/Options.h"
#include "vectorlib/io/MapSegment.h"
#include "vectorlib/io/Tum.h"
#include "vectorlib/mapping/MapBuilder.h"
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

    const std::vector<vectorlib::StampedPose> &trajectory() const { return m_trajectory; }
    /// Reference poses, one a pose of the trajectory; empty without reference.
    const std::vector<vectorlib::StampedPose> &reference() const { return m_reference; }
    std::vector<vectorlib::MapSegment> segments() const;
    /// Counts, milliseconds a scan and, with a reference, the errors against it.
    nlohmann::ordered_json summary() const;

private:
    bool isWellExpected(const MapScan &scan, double stamp) const;
    vectorlib::Pose2D expectedPose(const MapScan &scan, double stamp) const;
    nlohmann::ordered_json errors() const;

    vectorlib::MotionModel m_motion;
    std::vector<vectorlib::StampedPose> m_trajectory;
    std::vector<vectorlib::StampedPose> m_reference;
    std::vector<vectorlib::Vector2D<float>> m_points;
    std::size_t m_matched = 0, m_lost = 0, m_skipped = 0;
    double m_segmentMs = 0, m_vectorizeMs = 0, m_matchMs = 0, m_mapMs = 0;
};

} // namespace hermes
