#include "daemons/simulator/PathFollower.h"

#include <algorithm>
#include <cmath>

namespace hermes::simulator {

namespace {

constexpr double arrival = 1e-6; // seconds at full speed: a micrometre at 1 m/s

} // namespace

PathFollower::PathFollower(PosePath path, double acceleration)
    : path_(std::move(path))
    , acceleration_(acceleration) {}

void PathFollower::restart() {
    progress_ = rate_ = 0;
}

void PathFollower::advance(double seconds) {
    if (!driving_ && rate_ == 0)
        return;
    const double rest = path_.length() - progress_;
    const double change = acceleration_ * seconds;
    // The rate from which it can still come to rest where the path ends.
    const double brake = std::sqrt(2 * acceleration_ * std::max(0.0, rest));
    rate_ = driving_ ? std::min({1.0, rate_ + change, brake}) : std::max(0.0, rate_ - change);
    progress_ += rate_ * seconds;
    if (path_.length() - progress_ > arrival)
        return;
    progress_ = path_.length();
    rate_ = 0;
    driving_ = false;
}

} // namespace hermes::simulator
