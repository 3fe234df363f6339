#pragma once

#include "protocol/ros/Messages.h"
#include "vectorlib/geometry/Pose2D.h"

#include <Eigen/Geometry>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hermes::vector {

/// Where a frame lies in another one. Nothing where the numbers are none of a rotation and a place.
std::optional<Eigen::Isometry3d> isometryOf(const ros::Vector3 &place, const ros::Quaternion &turn);

/// The pose in the plane: where it is, and where its x axis points.
vectorlib::Pose2D poseOf(const Eigen::Isometry3d &frame);

/// Frames and their parents, as the topics of tf tell them: the first transform of each, and whether it
/// changed.
class FrameTree {
public:
    static constexpr std::size_t mostFrames = 10000;

    struct Edge {
        std::string parent;
        Eigen::Isometry3d inParent;
        bool moves = false;
    };

    /// false: the transform is none, or there are too many frames; it is left out.
    bool add(const ros::TransformStamped &transform);

    /// The frame, its parent and so on to the one without.
    std::vector<std::string> upFrom(const std::string &frame) const;
    /// Of a frame that upFrom() has, not its last one.
    const Edge &edge(const std::string &frame) const { return edges_.at(frame); }
    /// The first transform from a frame to one that is above it. Nothing where it is not.
    std::optional<Eigen::Isometry3d> between(const std::string &frame, const std::string &above) const;

private:
    std::map<std::string, Edge> edges_; ///< by the child
};

} // namespace hermes::vector
