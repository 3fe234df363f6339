#pragma once

#include "vectorlib/io/CarmenLog.h"
#include "vectorlib/motion/OdometryTrack.h"

#include <algorithm>

namespace vectorlib {

/// The way of the robot through a log, scan by scan, as its odometry tells it and as far as it can be
/// believed.
class CarmenDrive {
public:
    /// A motion is a leap when it is longer than leap_m and the way at fastest_mps, or turns by more than
    /// leap_rad and what is turned at fastest_radps; metres, radians, seconds.
    static constexpr double leap_m = 1, fastest_mps = 5, leap_rad = 0.8, fastest_radps = 3;
    static constexpr double longestPause_s = 5; ///< no more of the time counts
    static constexpr std::size_t repeated = 16; ///< a scan is compared with so many before it

    /// The log must outlive this.
    CarmenDrive(const CarmenLog &log, CarmenOdometryKind kind)
        : log_(log)
        , kind_(kind) {}

    /// Goes on to the next scan; there must be one.
    void advance() {
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
    /// Whether the last scan has the stamp and the ranges of one shortly before it.
    bool isRepeated() const { return isRepeated_; }
    /// The robot at the last scan; nothing where the log does not tell.
    std::optional<OdometryTrack> odometry() const {
        const Step &step = steps_.back();
        if (!step.isKnown)
            return std::nullopt;
        return OdometryTrack(step.epoch, {{log_.scans[steps_.size() - 1].stamp, step.robot.pose(), {}, {}}});
    }

    /// Repeated scans so far.
    std::size_t repetitions() const { return repeated_; }
    /// Leaps so far.
    std::size_t leaps() const { return leaps_; }

private:
    // The robot at a scan, by odometry since its last gap.
    struct Step {
        Transformation2D robot;
        std::uint64_t epoch = 0;
        std::size_t known = 0; // the last scan up to here with odometry
        bool isKnown = true;
    };

    static bool isSame(const CarmenScan &a, const CarmenScan &b) {
        return a.stamp == b.stamp && a.ranges == b.ranges;
    }
    Step stepTo(std::size_t i) {
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
    // The clock of a log may stand, or be set back: then it was any pause.
    static bool leaps(const Transformation2D &motion, double seconds) {
        const double pause = seconds > 0 ? std::min(seconds, longestPause_s) : longestPause_s;
        return motion.translation().norm() > leap_m + fastest_mps * pause ||
               std::abs(wrapAngle(motion.alpha())) > leap_rad + fastest_radps * pause;
    }

    const CarmenLog &log_;
    CarmenOdometryKind kind_;
    std::vector<Step> steps_;
    std::size_t repeated_ = 0, leaps_ = 0;
    bool isRepeated_ = false;
};

} // namespace vectorlib
