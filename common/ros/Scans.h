#pragma once

#include "common/ros/RobotModel.h"
#include "protocol/messages/Turns.h"
#include "protocol/ros/Messages.h"

namespace hermes::ros {

struct Told;

/// A revolution as a scan with the same rays each time, as slam_toolbox wants it. A direction in which
/// nothing came back is +inf; one that nothing is known of (it was lost, or the scanner may not look there)
/// is NaN.
class ScanBins {
public:
    bool operator()(const ScanMessage &in, const Told &told, LaserScan &out);

private:
    std::vector<bool> isSeen_; ///< of each ray: something came back from there once
};

/// Points with x, y, z, intensity, ring (0 is the lowest) and time, as the Velodyne driver of ROS lays them
/// out.
struct CloudPoints {
    bool operator()(const CloudMessage &in, const Told &told, PointCloud &out);
};

} // namespace hermes::ros
