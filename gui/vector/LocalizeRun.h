#pragma once

#include "gui/vector/MapSource.h"
#include "vectorlib/io/Tum.h"
#include "vectorlib/mapping/MapLocalizer.h"

namespace hermes::vector {

/// Finds the poses of a drive in a finished map and keeps account of it.
class LocalizeRun {
public:
    vectorlib::MapLocalizer localizer;

    /// `file` is how messages call the map.
    LocalizeRun(const std::vector<vectorlib::MapEdge> &map, std::string file)
        : localizer(map)
        , file_(std::move(file)) {}

    /// A scan with a fault is counted and left out.
    void take(const MapScan &scan);
    /// After the last scan. Throws Failure when no place was found: `log` is how the message calls the drive.
    void finish(const std::string &log);

    /// The scans with a pose.
    std::vector<vectorlib::StampedPose> trajectory() const;
    nlohmann::ordered_json summary() const;

private:
    std::string file_;
    std::size_t leftOut_ = 0;
};

} // namespace hermes::vector
