#include "gui/vector/BagOdometry.h"

#include "gui/vector/BagMessages.h"
#include "gui/vector/Failure.h"
#include "vectorlib/motion/OdometryFault.h"

#include <algorithm>

namespace hermes::vector {

namespace {

constexpr double longestStep_s = 0.5; // over a longer one no speed is told by two poses

double stampOr(const ros::Header &header, const bag::Message &message) {
    const double stamp = secondsOf(header.stamp);
    return stamp != 0 ? stamp : 1e-9 * double(message.time_ns);
}

} // namespace

BagOdometry::BagOdometry(const std::string &path, std::string topic)
    : reader_(valueOrFail(bag::open(path)))
    , topic_(std::move(topic)) {
    reader_->select([this](const bag::Topic &known) { return known.name == topic_ && isOdometry(known); });
}

BagOdometry::BagOdometry(const std::string &path, std::vector<std::string> way, const FrameTree &frames)
    : reader_(valueOrFail(bag::open(path)))
    , way_(std::move(way))
    , frames_(&frames) {
    reader_->select(isFrames);
    for (std::size_t i = 0; i + 1 < way_.size(); ++i) {
        isAnyMoving_ = isAnyMoving_ || frames.edge(way_[i]).moves;
        latest_.emplace(way_[i], frames.edge(way_[i]).inParent);
    }
}

std::optional<std::pair<std::uint64_t, vectorlib::OdometrySample>> BagOdometry::next() {
    while (const auto message = reader_->next())
        if (const auto sample = topic_.empty() ? sampleFromFrames(*message) : sampleFrom(*message))
            return std::pair(message->time_ns, *sample);
    return std::nullopt;
}

std::optional<vectorlib::OdometrySample> BagOdometry::sampleFrom(const bag::Message &message) {
    const auto odometry = messageFrom<ros::Odometry>(reader_->topics()[message.topic], message.data);
    const auto pose = odometry ? isometryOf({odometry->pose.pose.position.x, odometry->pose.pose.position.y,
                                             odometry->pose.pose.position.z},
                                            odometry->pose.pose.orientation)
                               : std::nullopt;
    if (!pose) {
        ++refused_;
        return std::nullopt;
    }
    const ros::Twist &twist = odometry->twist.twist;
    vectorlib::OdometrySample sample;
    sample.stamp = stampOr(odometry->header, message);
    sample.pose = poseOf(*pose);
    sample.twist = {twist.linear.x, twist.linear.y, twist.angular.z};
    return checked(sample);
}

/// Nothing where none of the frames that move is told anew.
std::optional<vectorlib::OdometrySample> BagOdometry::sampleFromFrames(const bag::Message &message) {
    const auto transforms = messageFrom<ros::TfMessage>(reader_->topics()[message.topic], message.data);
    std::optional<double> stamp;
    if (!transforms)
        return std::nullopt; // counted when all frames were read
    for (const ros::TransformStamped &transform : transforms->transforms) {
        const std::string child = plainFrame(transform.childFrameId);
        const auto at = std::find(way_.begin(), way_.end() - 1, child);
        const auto frame = isometryOf(transform.transform.translation, transform.transform.rotation);
        if (at == way_.end() - 1 || !frame || plainFrame(transform.header.frameId) != *(at + 1))
            continue;
        latest_.at(child) = *frame;
        if (frames_->edge(child).moves || !isAnyMoving_) // a fixed one may be told ahead of its time
            stamp = stampOr(transform.header, message);
    }
    if (!stamp)
        return std::nullopt;
    Eigen::Isometry3d robot = Eigen::Isometry3d::Identity();
    for (std::size_t i = 0; i + 1 < way_.size(); ++i)
        robot = latest_.at(way_[i]) * robot;
    vectorlib::OdometrySample sample;
    sample.stamp = *stamp;
    sample.pose = poseOf(robot);
    return checked(sample);
}

/// With the speed that the last two poses tell where it has none. Nothing where no robot can tell so.
std::optional<vectorlib::OdometrySample> BagOdometry::checked(vectorlib::OdometrySample sample) {
    vectorlib::Twist2D &twist = sample.twist;
    const double seconds = last_ ? sample.stamp - last_->stamp : 0;
    if (twist.vx == 0 && twist.vy == 0 && twist.omega == 0 && seconds > 0 && seconds < longestStep_s) {
        twist = vectorlib::Twist2D::between(last_->pose.inverse() * sample.pose, seconds);
        if (!vectorlib::faultOf(sample).empty())
            twist = {}; // a leap, of which there is no speed
    }
    if (!vectorlib::faultOf(sample).empty()) {
        ++refused_;
        return std::nullopt;
    }
    last_ = sample;
    return sample;
}

} // namespace hermes::vector
