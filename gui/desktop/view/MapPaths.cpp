// The ways of the robot in a map model: they belong to the map that they were driven in.
#include "gui/desktop/view/MapModel.h"
#include "gui/desktop/view/Plausible.h"

#include <algorithm>
#include <cmath>

namespace hermes::desktop {

void MapModel::clearPaths() {
    paths_ = {};
    Q_EMIT changed();
}

/// Where the robot is in the new one is not known yet, so no path begins before it is told.
void MapModel::turnTo(MapKey map) {
    endGlide();
    for (DrivenPath &path : paths_)
        path.loosen(); // the graph that it was fixed to is gone
    aside_.emplace_back(map_, std::exchange(paths_, {}));
    map_ = map;
    const auto isOfIt = [&](const auto &one) { return one.first == map; };
    if (const auto kept = std::find_if(aside_.begin(), aside_.end(), isOfIt); kept != aside_.end()) {
        paths_ = std::move(kept->second);
        aside_.erase(kept);
    }
    if (aside_.size() > maxAside)
        aside_.pop_front();
    pose_.reset();
    covariance_.reset();
    odometryFrame_.reset();
    Q_EMIT replaced();
}

void MapModel::forgetPath(MovingMap::Path path) {
    endGlide();
    paths_[path] = {};
    Q_EMIT changed();
}

PathMoment MapModel::moment(const Twist2D &twist) const {
    return {stamp_, isPlausible(twist) ? std::hypot(twist.vx, twist.vy) : 0};
}

void MapModel::follow(DrivenPath &path, const Pose2D &pose, const Twist2D &twist) {
    if (!path.frame && (poseLead_ != 0 || (!pose_ && poses_.source())))
        return; // nothing to lay it against yet
    if (!isPlausible(pose)) {
        ++ignored_;
        return Q_EMIT changed();
    }
    if (!path.frame) {
        path.frame = pose_ ? *pose_ * pose.inverse() : Pose2D();
        path.frameKeyScan = newestKeyScan();
    }
    path.add(*path.frame * pose, moment(twist), path.frameKeyScan);
}

} // namespace hermes::desktop
