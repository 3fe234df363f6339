#include "daemons/motorcontrol/StandstillWatch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hermes::motorcontrol {
namespace {

// An encoder at the border of two counts may jitter by one. So long that a motion at the threshold shows
// more.
constexpr double jitter = 1, shortestWindow_s = 0.04, longestWindow_s = 1;
// What goes on for so long counts as motion at a fiftieth of the threshold, too; a wheel that is held
// jitters.
constexpr double creepWindow_s = 1, creepShare = 0.02, heldJitter = 2;

double largestChange(const std::array<quint32, 2> &before, const std::array<quint32, 2> &now) {
    double largest = 0;
    for (std::size_t i = 0; i < 2; ++i)
        largest = std::max(largest, std::abs(double(qint32(now[i] - before[i]))));
    return largest;
}

} // namespace

void StandstillWatch::setThreshold(double speed) {
    threshold_ = speed;
    window_ = std::clamp(2 * jitter / std::max(speed, 1e-3), shortestWindow_s, longestWindow_s);
}

void StandstillWatch::doubt() {
    acknowledged_ = still_ = moving_ = creeping_ = false;
    baseTime_ = 0;
}

void StandstillWatch::acknowledged() {
    if (acknowledged_)
        return;
    acknowledged_ = true;
    still_ = false;
    baseTime_ = 0; // what was read before does not count
}

void StandstillWatch::read(const Counts &counts, double time) {
    if (lastTime_ > 0 && time > lastTime_)
        speed_ = largestChange(last_, counts) / (time - lastTime_);
    last_ = counts;
    lastTime_ = time;
    const double change = largestChange(base_, counts), elapsed = time - baseTime_;
    moving_ = baseTime_ > 0 && change > std::max(jitter, threshold_ * elapsed);
    if (baseTime_ > 0 && !moving_ && elapsed < window_)
        return;
    const bool wasStill = std::exchange(still_, baseTime_ > 0 && !moving_);
    base_ = counts;
    baseTime_ = time;
    watchCreep(wasStill, counts, time);
}

void StandstillWatch::watchCreep(bool wasStill, const Counts &counts, double time) {
    const double elapsed = time - creepTime_;
    if (wasStill && elapsed < creepWindow_s)
        return;
    creeping_ = wasStill &&
                largestChange(creepBase_, counts) > std::max(heldJitter, creepShare * threshold_ * elapsed);
    creepBase_ = counts;
    creepTime_ = time;
}

} // namespace hermes::motorcontrol
