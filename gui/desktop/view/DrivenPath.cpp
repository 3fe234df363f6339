#include "gui/desktop/view/DrivenPath.h"

#include <QLineF>
#include <algorithm>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr double step_m = 0.02;
constexpr int maxPoints = 100000;
/// Nobody knows what the robot did meanwhile.
constexpr double longestGap_s = 3, longestFastGap_s = 30;
/// How far the robot can have come: what poses are wrong by, the faster of both speeds and half as much more,
/// and what it can have accelerated between.
constexpr double slack_m = 0.1, speedFactor = 1.5, acceleration = 1, fastest = 10;

} // namespace

QPointF operator*(const Pose2D &pose, QPointF point) {
    const double c = std::cos(pose.theta), s = std::sin(pose.theta);
    return {pose.x + c * point.x() - s * point.y(), pose.y + s * point.x() + c * point.y()};
}

bool DrivenPath::isJump(double distance_m, const PathMoment &moment) const {
    const double gap_s = moment.stamp - last_.stamp;
    // A replay may be so fast that what is told of it lies far apart.
    const double longest_s = std::max(longestGap_s, std::min(3 * lastGap_s_, longestFastGap_s));
    if (!(gap_s >= 0 && gap_s <= longest_s))
        return true;
    const double speed = std::min(std::max(last_.speed, moment.speed), fastest);
    const double sped_s = std::min(gap_s, longestGap_s);
    return !(distance_m <= slack_m + speedFactor * speed * gap_s + acceleration * sped_s * sped_s / 2);
}

void DrivenPath::forgetOldest(int count) {
    way_.remove(0, count);
    keyScans_.remove(0, count);
    for (int &first : breaks_)
        first -= count;
    breaks_.erase(breaks_.begin(), std::upper_bound(breaks_.begin(), breaks_.end(), 0));
}

void DrivenPath::add(const Pose2D &pose, const PathMoment &moment, int keyScan) {
    const QPointF point(pose.x, pose.y);
    const double distance = way_.isEmpty() ? 0 : QLineF(way_.back(), point).length();
    const bool isBroken = distance >= step_m && isJump(distance, moment);
    lastGap_s_ = way_.isEmpty() ? 0 : moment.stamp - last_.stamp;
    last_ = moment;
    if (!way_.isEmpty() && distance < step_m)
        return;
    if (way_.size() >= maxPoints)
        forgetOldest(maxPoints / 10);
    if (isBroken)
        breaks_.append(way_.size());
    way_.append(point);
    keyScans_.append(keyScan);
}

void DrivenPath::fix(int keyScan) {
    std::replace(keyScans_.begin(), keyScans_.end(), loose, keyScan);
    if (frameKeyScan == loose)
        frameKeyScan = keyScan;
}

void DrivenPath::loosen() {
    keyScans_.fill(loose);
    frameKeyScan = loose;
}

void DrivenPath::correct(const QVector<Pose2D> &before, const QVector<Pose2D> &after) {
    const int common = qMin(before.size(), after.size());
    const auto correction = [&](int number) { return after[number] * before[number].inverse(); };
    int last = loose;
    Pose2D move;
    for (int i = 0; i < way_.size(); ++i) {
        const int number = keyScans_[i];
        if (number < 0 || number >= common)
            continue;
        if (number != last)
            move = correction(number);
        last = number;
        way_[i] = move * way_[i];
    }
    if (frame && frameKeyScan >= 0 && frameKeyScan < common)
        frame = correction(frameKeyScan) * *frame;
}

} // namespace hermes::desktop
