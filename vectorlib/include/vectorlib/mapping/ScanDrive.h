#pragma once

#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/Pose2D.h"

#include <vector>

namespace vectorlib {

/// What a whole drive saw: the edges of each scan (sensor frame) and the pose of each (map frame). As many
/// poses as scans; a scan in doubt has no edges. Owns neither.
struct ScanDrive {
    const std::vector<std::vector<EdgeRaw2D>> &edges;
    const std::vector<Pose2D> &poses;
};

} // namespace vectorlib
