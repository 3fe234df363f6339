#include "vectorlib/io/CarmenDrive.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY void CarmenDrive::advance() {
    const std::size_t i = steps_.size();
    steps_.emplace_back();
    isRepeated_ = false;
    for (std::size_t back = 1; back <= std::min(repeated, i) && !isRepeated_; ++back)
        if (isSame(log_.scans[i - back], log_.scans[i])) {
            isRepeated_ = true;
            ++repeated_;
            steps_[i] = steps_[i - back];
        }
    if (!isRepeated_)
        steps_[i] = i > 0 ? stepTo(i) : Step{{}, 0, i, log_.scans[i].hasOdometry};
}

VECTORLIB_BODY std::optional<OdometryTrack> CarmenDrive::odometry() const {
    const Step &step = steps_.back();
    if (!step.isKnown)
        return std::nullopt;
    return OdometryTrack(step.epoch,
                         {{log_.scans[steps_.size() - 1].stamp, step.robot.pose() * mount_, twist(), {}}});
}

VECTORLIB_BODY Twist2D CarmenDrive::twist() const {
    const std::size_t i = steps_.size() - 1;
    const std::size_t from = i > 0 ? i - 1 : i, to = std::min(i + 1, log_.scans.size() - 1);
    const double seconds = log_.scans[to].stamp - log_.scans[from].stamp;
    const auto motion = log_.odometryMotion(from, to, kind_);
    if (!motion || !(seconds > 0) || seconds > longestPause_s || leaps(*motion, seconds))
        return {};
    return Twist2D::between(mount_.inverse() * motion->pose() * mount_, seconds);
}

VECTORLIB_BODY CarmenDrive::Step CarmenDrive::stepTo(std::size_t i) {
    Step step = steps_[i - 1];
    const bool isRaw = kind_ == CarmenOdometryKind::Raw;
    step.isKnown = !isRaw || log_.scans[i].hasOdometry;
    if (!step.isKnown)
        return step;
    const std::size_t from = isRaw ? step.known : i - 1;
    const auto motion = log_.odometryMotion(from, i, kind_);
    step.known = i;
    const bool isLeap = motion && leaps(*motion, log_.scans[i].stamp - log_.scans[from].stamp);
    leaps_ += isLeap;
    if (motion && !isLeap)
        step.robot = step.robot * *motion;
    else
        ++step.epoch;
    return step;
}

VECTORLIB_BODY bool CarmenDrive::leaps(const Transformation2D &motion, double seconds) {
    const double pause = seconds > 0 ? std::min(seconds, longestPause_s) : longestPause_s;
    return motion.translation().norm() > leap_m + fastest_mps * pause ||
           std::abs(wrapAngle(motion.alpha())) > leap_rad + fastest_radps * pause;
}

} // namespace vectorlib
