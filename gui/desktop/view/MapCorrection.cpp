// How a map model takes a correction of the map: edges, graph and pose tell of it in messages of their own.
#include "gui/desktop/view/MapModel.h"
#include "gui/desktop/view/Plausible.h"

#include <cmath>

namespace hermes::desktop {

void MapModel::onGraph(const GraphMessage &message) {
    if (message.cleared && message.size > 0 && graph_.known().size() > 0) {
        expectCorrection(GraphSign);
        if (before_.isEmpty())
            before_ = graph_.known().poses;
    } else if (message.cleared) {
        forgetGraph();
    }
    const bool isNext = graph_.take(message);
    ignored_ += graph_.takeIgnored();
    if (!isNext)
        graphs_.renew();
    else if (graph_.isWhole() && graph_.known().size() > 0)
        graphIsWhole();
    resume();
    Q_EMIT changed();
}

/// Another drive begins: its key scans are not those that had the same numbers.
void MapModel::forgetGraph() {
    endGlide();
    before_.clear();
    for (DrivenPath &path : paths_)
        path.loosen();
}

void MapModel::graphIsWhole() {
    const QVector<Pose2D> before = std::exchange(before_, {}), &after = graph_.known().poses;
    if (before.size() > after.size())
        forgetGraph();
    else if (!before.isEmpty())
        correctPaths(before);
    for (DrivenPath &path : paths_)
        path.fix(newestKeyScan());
}

void MapModel::correctPaths(const QVector<Pose2D> &before) {
    double farthest = 0;
    for (int i = 0; i < before.size(); ++i) {
        const Pose2D &after = graph_.known().poses[i];
        farthest = qMax(farthest, std::hypot(after.x - before[i].x, after.y - before[i].y));
    }
    if (farthest == 0) // it came again as it was
        return endGlide();
    if (glide_.phase() == Glide::Phase::Holds) // else it waited long enough
        poseLead_ = qMax(-1, poseLead_ - 1);
    for (DrivenPath &path : paths_)
        path.correct(before, graph_.known().poses);
    if (farthest < Glide::leastMove_m)
        return;
    correction_m_ = farthest;
    notice_.start();
}

/// The number of the key scan that the robot drives on from, of those that the path is fixed to.
int MapModel::newestKeyScan() const {
    if (!before_.isEmpty())
        return before_.size() - 1;
    return graph_.isWhole() ? graph_.known().size() - 1 : DrivenPath::loose;
}

// What was seen of the robot stays where it was, seen from the robot.
void MapModel::takeLeap(const PoseMessage &message) {
    const auto frame = message.odometryFrame;
    const bool isFrame = !frame || isPlausible(*frame);
    ignored_ += !isFrame;
    const auto before = std::exchange(odometryFrame_, isFrame ? frame : std::nullopt);
    if (!message.corrected || !pose_ || graph_.known().size() == 0)
        return;
    const Pose2D leap =
        before && odometryFrame_ ? *odometryFrame_ * before->inverse() : message.pose * pose_->inverse();
    expectCorrection(PoseSign);
    glide_.leap(leap);
    poseLead_ = qMin(1, poseLead_ + 1);
    for (QPointF &point : scan_)
        point = leap * point;
    for (QLineF &segment : segments_)
        segment = QLineF(leap * segment.p1(), leap * segment.p2());
    correspondences_.clear();
}

/// Edges, graph and pose of the corrected map come one after the other: until then the picture stands.
void MapModel::expectCorrection(Sign sign) {
    if (glide_.phase() != Glide::Phase::Holds) {
        frames_.stop();
        MovingMap now;
        now.edges = edges_;
        now.graph = graph_.known();
        for (std::size_t i = 0; i < paths_.size(); ++i)
            now.ways[i] = paths_[i].way();
        glide_.hold(now, pose_.value_or(Pose2D()));
        signs_ = 0;
        glideClock_.start();
        wait_.start();
    }
    signs_ |= sign;
}

/// After each message: the picture waits on, or begins to move.
void MapModel::resume() {
    if (glide_.phase() != Glide::Phase::Holds)
        return;
    const bool areParts = !isWhole() || !graph_.isWhole();
    if (signs_ == AllSigns && !areParts)
        startGlide();
    else if (areParts && glideClock_.elapsed() < partsWait.count())
        wait_.start();
}

void MapModel::onWaitOver() {
    const bool isMap = (signs_ & MapSign) && isWhole(), isGraph = (signs_ & GraphSign) && graph_.isWhole();
    isMap &&isGraph ? startGlide() : endGlide();
}

void MapModel::startGlide() {
    wait_.stop();
    poseLead_ = 0;
    if (!glide_.start(edges_.size(), graph_.known()))
        return endGlide();
    glideClock_.start();
    frames_.start();
    showGlide();
}

void MapModel::showGlide() {
    const double part = double(glideClock_.elapsed()) / (1000 * Glide::duration_s);
    if (part >= 1)
        return endGlide();
    glide_.show(part, edges_, graph_.known(), paths_);
    Q_EMIT changed();
}

void MapModel::endGlide() {
    wait_.stop();
    frames_.stop();
    poseLead_ = 0;
    glide_.end();
    Q_EMIT changed();
}

} // namespace hermes::desktop
