#include "gui/desktop/view/DrivenPath.h"

#include <QLineF>
#include <algorithm>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr double step_m = 0.02;
constexpr int mostPoints = 100000;

} // namespace

QPointF operator*(const Pose2D &pose, QPointF point) {
    const double c = std::cos(pose.theta), s = std::sin(pose.theta);
    return {pose.x + c * point.x() - s * point.y(), pose.y + s * point.x() + c * point.y()};
}

void DrivenPath::add(const Pose2D &pose, int keyScan) {
    const QPointF point(pose.x, pose.y);
    if (!way_.isEmpty() && QLineF(way_.back(), point).length() < step_m)
        return;
    if (way_.size() >= mostPoints) {
        way_.remove(0, mostPoints / 10);
        keyScans_.remove(0, mostPoints / 10);
    }
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
