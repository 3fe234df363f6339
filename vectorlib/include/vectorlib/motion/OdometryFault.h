#pragma once

#include "vectorlib/motion/MotionModel.h"
#include "vectorlib/motion/Odometry.h"

#include <cmath>
#include <sstream>
#include <string>

namespace vectorlib {

/// What of a sample no robot can tell, by the names that members of messages have; empty: nothing.
inline std::string faultOf(const OdometrySample &sample) {
    constexpr double latest = 1e10; // seconds since the epoch: beyond it stamps lose their digits
    std::ostringstream text;
    const Twist2D &twist = sample.twist;
    if (!(sample.stamp >= 0 && sample.stamp <= latest))
        text << "stamp: found " << sample.stamp << ", expected a number from 0 to " << latest
             << ", in seconds since the Unix epoch, not in milliseconds";
    else if (!(std::hypot(twist.vx, twist.vy) <= MotionModel::fastest_mps &&
               std::abs(twist.omega) <= MotionModel::fastest_radps))
        text << "member twist: found " << twist.vx << " m/s, " << twist.vy << " m/s and " << twist.omega
             << " rad/s, expected what a robot can: " << MotionModel::fastest_mps << " m/s and "
             << MotionModel::fastest_radps << " rad/s at most";
    else if (sample.covariance)
        for (int i = 0; i < 3 && text.tellp() == 0; ++i)
            if (const double variance = (*sample.covariance)(i, i); !(variance >= 0))
                text << "member covariance." << 4 * i << ": found " << variance
                     << ", expected a variance of at least 0";
    return text.str();
}

} // namespace vectorlib
