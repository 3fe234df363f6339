#include "gui/vector/FrameTree.h"

#include "gui/vector/BagMessages.h"

#include <cmath>

namespace hermes::vector {

namespace {

constexpr double still_m = 0.01, still_rad = 0.01; // what changes less is fixed
constexpr double farthest_m = 1e7;

} // namespace

std::optional<Eigen::Isometry3d> isometryOf(const ros::Vector3 &place, const ros::Quaternion &turn) {
    Eigen::Quaterniond rotation(turn.w, turn.x, turn.y, turn.z);
    const Eigen::Vector3d at(place.x, place.y, place.z);
    if (!(std::abs(rotation.norm() - 1) < 0.1) || !(at.norm() < farthest_m))
        return std::nullopt;
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.linear() = rotation.normalized().toRotationMatrix();
    frame.translation() = at;
    return frame;
}

vectorlib::Pose2D poseOf(const Eigen::Isometry3d &frame) {
    const Eigen::Matrix3d turn = frame.linear();
    return {frame.translation().x(), frame.translation().y(), std::atan2(turn(1, 0), turn(0, 0))};
}

bool FrameTree::add(const ros::TransformStamped &transform) {
    const std::string child = plainFrame(transform.childFrameId),
                      parent = plainFrame(transform.header.frameId);
    const auto frame = isometryOf(transform.transform.translation, transform.transform.rotation);
    const auto known = edges_.find(child);
    if (!frame || (known == edges_.end() && edges_.size() == mostFrames))
        return false;
    if (known == edges_.end() || known->second.parent != parent) {
        edges_.insert_or_assign(child, Edge{parent, *frame, false});
        return true;
    }
    const Eigen::Isometry3d change = known->second.inParent.inverse() * *frame;
    const double angle = Eigen::AngleAxisd(change.linear()).angle();
    known->second.moves = known->second.moves || change.translation().norm() > still_m || angle > still_rad;
    return true;
}

std::vector<std::string> FrameTree::upFrom(const std::string &frame) const {
    std::vector<std::string> frames{plainFrame(frame)};
    for (auto found = edges_.find(frames[0]); found != edges_.end() && frames.size() <= edges_.size();
         found = edges_.find(frames.back()))
        frames.push_back(found->second.parent);
    return frames;
}

std::optional<Eigen::Isometry3d> FrameTree::between(const std::string &frame,
                                                    const std::string &above) const {
    Eigen::Isometry3d sum = Eigen::Isometry3d::Identity();
    for (const std::string &at : upFrom(frame)) {
        if (at == plainFrame(above))
            return sum;
        if (const auto found = edges_.find(at); found != edges_.end())
            sum = found->second.inParent * sum;
    }
    return std::nullopt;
}

} // namespace hermes::vector
