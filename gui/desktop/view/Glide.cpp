#include "gui/desktop/view/Glide.h"

#include <QtMath>

namespace hermes::desktop {
namespace {

constexpr double cell_m = 2;
constexpr int farthestCells = 3; // an edge stands still that is farther from any key scan

Pose2D between(const Pose2D &from, const Pose2D &to, double part) {
    return {from.x + part * (to.x - from.x), from.y + part * (to.y - from.y),
            from.theta + part * vectorlib::wrapAngle(to.theta - from.theta)};
}

QTransform moving(const Pose2D &pose) {
    const double c = std::cos(pose.theta), s = std::sin(pose.theta);
    return {c, s, -s, c, pose.x, pose.y};
}

} // namespace

Pose2D Glide::shownPose(const Pose2D &pose) const {
    return phase_ == Phase::Rests ? pose : between(robot_ * pose, pose, part_);
}

void Glide::hold(const MovingMap &now, const Pose2D &pose) {
    if (phase_ == Phase::Rests)
        shown_ = now;
    robot_ = shownPose(pose) * pose.inverse();
    part_ = 0;
    phase_ = Phase::Holds;
}

bool Glide::start(int edges, const KeyScans &corrected) {
    from_ = shown_.graph.poses;
    const int common = from_.size();
    if (common == 0 || common > corrected.size() || corrected.size() > maxKeyScans || edges > maxEdges) {
        end();
        return false;
    }
    double farthest = 0;
    for (int i = 0; i < common; ++i)
        farthest =
            qMax(farthest, std::hypot(from_[i].x - corrected.poses[i].x, from_[i].y - corrected.poses[i].y));
    if (farthest < leastMove_m) {
        end();
        return false;
    }
    const Pose2D move = from_.back() * corrected.poses[common - 1].inverse();
    for (int i = common; i < corrected.size(); ++i)
        from_.append(move * corrected.poses[i]);
    cells_.clear();
    for (int i = corrected.size() - 1; i >= 0; --i)
        cells_.insert(cellOf({corrected.poses[i].x, corrected.poses[i].y}), i);
    phase_ = Phase::Moves;
    return true;
}

void Glide::show(double part, const QVector<QLineF> &edges, const KeyScans &graph,
                 const std::array<DrivenPath, 3> &paths) {
    part_ = part * part * (3 - 2 * part); // starts and ends gently
    showKeyScans(graph);
    shown_.edges.resize(edges.size());
    for (int i = 0; i < edges.size(); ++i) {
        const int keyScan = nearest(edges[i].center());
        shown_.edges[i] = keyScan < 0 ? edges[i] : undoing(keyScan).map(edges[i]);
    }
    for (std::size_t i = 0; i < paths.size(); ++i)
        showWay(shown_.ways[i], paths[i]);
}

void Glide::end() {
    phase_ = Phase::Rests;
    shown_ = {};
    from_.clear();
    undoing_.clear();
    cells_.clear();
    robot_ = {};
    part_ = 0;
}

void Glide::showKeyScans(const KeyScans &graph) {
    undoing_.resize(from_.size());
    shown_.graph = graph;
    for (int i = 0; i < graph.size(); ++i) {
        const Pose2D &to = graph.poses[i];
        const Pose2D &at = shown_.graph.poses[i] = i < from_.size() ? between(from_[i], to, part_) : to;
        if (i < from_.size())
            undoing_[i] = moving(at * to.inverse());
    }
}

void Glide::showWay(QPolygonF &shown, const DrivenPath &path) const {
    shown = path.way();
    for (int i = 0; i < shown.size(); ++i)
        if (path.keyScans()[i] >= 0)
            shown[i] = undoing(path.keyScans()[i]).map(shown[i]);
}

Glide::Cell Glide::cellOf(QPointF point) {
    return {qFloor(point.x() / cell_m), qFloor(point.y() / cell_m)};
}

/// A key scan of the nearest cell that has one; negative: none is near.
int Glide::nearest(QPointF point) const {
    const Cell centre = cellOf(point);
    for (int ring = 0; ring <= farthestCells; ++ring)
        for (int dx = -ring; dx <= ring; ++dx)
            for (int dy = -ring; dy <= ring; dy += std::abs(dx) == ring || ring == 0 ? 1 : 2 * ring) {
                const auto found = cells_.constFind({centre.first + dx, centre.second + dy});
                if (found != cells_.constEnd())
                    return *found;
            }
    return -1;
}

} // namespace hermes::desktop
