#pragma once

#include "gui/vector/FrameTree.h"
#include "protocol/bag/Reader.h"
#include "vectorlib/motion/Odometry.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hermes::vector {

/// What the odometry of a robot told, by a bag. Throws Failure where the bag cannot be opened again.
class BagOdometry {
public:
    /// Of a topic of nav_msgs/Odometry.
    BagOdometry(const std::string &path, std::string topic);
    /// Of tf: where the first frame of the way is in the last one, over those between. The tree outlives
    /// this.
    BagOdometry(const std::string &path, std::vector<std::string> way, const FrameTree &frames);

    /// The time of the next sample in the bag, and that sample; nothing at the end.
    std::optional<std::pair<std::uint64_t, vectorlib::OdometrySample>> next();
    std::optional<vectorlib::OdometrySample> nextSample() {
        const auto sample = next();
        return sample ? std::optional(sample->second) : std::nullopt;
    }
    /// Samples that no robot can tell.
    std::size_t refused() const { return refused_; }
    std::string problem() const { return reader_->problem(); } ///< as of the reader

private:
    std::optional<vectorlib::OdometrySample> sampleFrom(const bag::Message &message);
    std::optional<vectorlib::OdometrySample> sampleFromFrames(const bag::Message &message);
    std::optional<vectorlib::OdometrySample> checked(vectorlib::OdometrySample sample);

    std::unique_ptr<bag::Reader> reader_;
    std::string topic_; ///< empty: by tf
    std::vector<std::string> way_;
    const FrameTree *frames_ = nullptr;
    std::map<std::string, Eigen::Isometry3d> latest_; ///< of the frames on the way
    bool isAnyMoving_ = false;                        ///< of these
    std::optional<vectorlib::OdometrySample> last_;
    std::size_t refused_ = 0;
};

} // namespace hermes::vector
