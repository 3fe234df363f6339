#include "vectorlib/graph/LoopCloser.h"

#include <cmath>
#include <utility>

namespace vectorlib {

VECTORLIB_BODY void LoopCloser::add(PointSpan<float> points, const Transformation2D &tracked, TrackedBy by) {
    if (keys_.empty()) {
        graph_.poses.push_back(tracked.pose());
        addKey(points, tracked.pose(), 0);
        return;
    }
    const double doubt = addMotion(points, tracked, by);
    const double way = since_.way, turned = since_.turned;
    if (by > TrackedBy::Scan || way >= settings.keyWay || turned >= settings.keyTurn) {
        link(points);
        if (doubt > 0 && by != TrackedBy::Placed) // those before it lie anywhere
            bridge();
        tryLoops();
    } else {
        scans_.push_back({keys_.size() - 1, since_.motion, way + turned});
        last_.assign(points.begin(), points.end());
    }
}

VECTORLIB_BODY bool LoopCloser::isDue() const {
    const auto few = static_cast<std::size_t>(settings.fewPart * double(keys_.size()));
    return news_ && keys_.size() - corrected_ >= std::max(settings.fewKeys, few);
}

VECTORLIB_BODY bool
LoopCloser::correct(const std::function<void(std::size_t done, std::size_t all)> &progress) {
    news_ = false;
    corrected_ = keys_.size();
    if (!std::exchange(found_, false) || !graph_.optimise(progress))
        return false;
    counts_.closed = 0;
    for (const PoseConstraint &c : graph_.constraints)
        counts_.closed += c.mayBeWrong && !c.isRefused();
    candidates_.move(graph_.poses);
    findLooped();
    return true;
}

VECTORLIB_BODY Pose2D LoopCloser::pose(std::size_t scan) const {
    const OnTheWay &s = scans_[scan];
    const Transformation2D from(graph_.poses[s.key]);
    if (s.key + 1 == keys_.size())
        return (from * s.motion).pose();
    const Key &next = keys_[s.key + 1];
    const Transformation2D off =
        from.inverse() * Transformation2D(graph_.poses[s.key + 1]) * next.motion.inverse();
    const double part = next.effort > 0 ? std::min(1.0, s.effort / next.effort) : 0;
    return (from * Transformation2D(part * off.x(), part * off.y(), part * off.alpha()) * s.motion).pose();
}

VECTORLIB_BODY std::vector<Pose2D> LoopCloser::poses() const {
    std::vector<Pose2D> result(scans_.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = pose(i);
    return result;
}

VECTORLIB_BODY void LoopCloser::restore(Memory memory) {
    keys_ = std::move(memory.keys);
    scans_ = std::move(memory.scans);
    since_ = memory.since;
    graph_ = std::move(memory.graph);
    counts_ = memory.progress.counts;
    found_ = memory.progress.found;
    news_ = memory.progress.news;
    corrected_ = memory.progress.corrected;
    last_.clear();
    agreement.clear();
    candidates_ = LoopCandidates();
    gate_.clear();
    pointBytes_ = 0;
    for (std::size_t k = 0; k < keys_.size(); ++k) {
        pointBytes_ += keys_[k].points.bytes();
        keys_[k].points.unpack(earlier_);
        enter(k, earlier_);
    }
    findLooped();
}

VECTORLIB_BODY double LoopCloser::addMotion(PointSpan<float> points, const Transformation2D &tracked,
                                            TrackedBy by) {
    Transformation2D motion = tracked;
    double xy = 0, alpha = 0, doubt = 0;
    if (by == TrackedBy::Placed) {
        agreement.clear();
        doubt = settings.guessedXY;
        xy = doubt + motion.translation().norm();
        alpha = settings.placedAlpha;
    } else if (by > TrackedBy::Scan) {
        const GlobalPairMatch &found = match(last_, points);
        const bool isLikely = by == TrackedBy::Nothing && !found.solutions.empty() &&
                              found.solutions[0].probability > settings.likely;
        if (found.isAccepted() || isLikely)
            motion = found.solutions[0].pose;
        if (!found.isAccepted()) {
            const double part = by == TrackedBy::Odometry ? settings.odometryPart : 1;
            doubt = xy = part * (settings.guessedXY + settings.guessedPart * motion.translation().norm());
            alpha = settings.guessedAlpha;
        }
    }
    const double way = motion.translation().norm(), turn = std::abs(motion.alpha());
    constexpr double least = 1e-3; // metres, radians; of standing, too
    xy = std::hypot(xy, least, settings.trackedXY * std::sqrt(way));
    alpha = std::hypot(std::hypot(alpha, least), settings.trackedAlpha * std::sqrt(way),
                       settings.turnedAlpha * std::sqrt(turn));
    since_.motion = since_.motion * motion;
    since_.way += way;
    since_.turned += turn;
    since_.varianceXY += xy * xy;
    since_.varianceAlpha += alpha * alpha;
    since_.doubt += settings.drift * way + doubt;
    return doubt;
}

VECTORLIB_BODY void LoopCloser::addKey(PointSpan<float> points, const Pose2D &tracked, double doubt) {
    Key key;
    key.points = PackedPoints(points);
    pointBytes_ += key.points.bytes();
    key.scan = scans_.size();
    key.motion = since_.motion;
    key.effort = since_.way + since_.turned;
    key.varianceXY = since_.varianceXY;
    key.varianceAlpha = since_.varianceAlpha;
    key.tracked = tracked;
    key.way = (keys_.empty() ? 0 : keys_.back().way) + since_.way;
    key.doubt = doubt;
    scans_.push_back({keys_.size(), {}, 0});
    last_.assign(points.begin(), points.end());
    keys_.push_back(std::move(key));
    enter(keys_.size() - 1, points);
    since_ = SinceKey();
}

VECTORLIB_BODY void LoopCloser::link(PointSpan<float> points) {
    const std::size_t from = keys_.size() - 1;
    const double xy = 1 / since_.varianceXY, alpha = 1 / since_.varianceAlpha;
    graph_.constraints.push_back(
        {from, from + 1, since_.motion, Eigen::Vector3d(xy, xy, alpha).asDiagonal(), false, 1});
    graph_.poses.push_back((Transformation2D(graph_.poses[from]) * since_.motion).pose());
    addKey(points, (Transformation2D(keys_[from].tracked) * since_.motion).pose(),
           keys_[from].doubt + since_.doubt);
}

VECTORLIB_BODY void LoopCloser::enter(std::size_t k, PointSpan<float> points) {
    const Key &key = keys_[k];
    if (key.varianceAlpha >= settings.placedAlpha * settings.placedAlpha)
        gate_.addPlaced(k);
    candidates_.add(
        {key.tracked, key.varianceXY, key.varianceAlpha, key.way, key.doubt, ScanSignature(points)},
        graph_.poses[k]);
}

VECTORLIB_BODY void LoopCloser::bridge() {
    const std::size_t key = keys_.size() - 1;
    for (std::size_t back = 2; back <= settings.maxBridged && back <= key; ++back)
        if (const auto loop = gate_.isAcross(key - back, key) ? std::nullopt : loopWith(key - back))
            believe(*loop);
}

VECTORLIB_BODY void LoopCloser::tryLoops() {
    const std::size_t last = keys_.size() - 1;
    const auto waiting = agreement.newest(keys_[last].way);
    tried_.clear();
    tryNearest(graph_.poses[last], settings.perScan, 0);
    if (waiting && looped_ != last) {
        const Transformation2D there = Transformation2D(graph_.poses[waiting->loop.from]) *
                                       waiting->loop.motion * candidates_.led(waiting->loop.to, last);
        tryNearest(there.pose(), 1, waiting->loop.to);
    }
    if (looped_ == last)
        return;
    if (const auto far = candidates_.far(looped_, tried_, settings)) {
        tryLoop(far->scan, far->among);
    }
}

VECTORLIB_BODY void LoopCloser::tryLoop(std::size_t earlier, std::size_t among) {
    tried_.push_back(earlier);
    const auto loop = loopWith(earlier);
    if (!loop)
        return;
    const PoseConstraint *known = gate_.nearestAcross(*loop, graph_, candidates_);
    const bool isOpen = !known && gate_.isAcross(loop->from, loop->to), near = isNear(*loop, known);
    if (near && !isOpen)
        return believe(*loop);
    if (isOpen && !near)
        return; // where the sensor was put is told, and not far off
    const auto tens = static_cast<std::size_t>(std::log10(double(among)));
    for (const PoseConstraint &c :
         agreement.add(*loop, end(loop->from), end(loop->to), settings.farAgreeing + tens))
        believe(c);
}

VECTORLIB_BODY bool LoopCloser::isNear(const PoseConstraint &c, const PoseConstraint *known) const {
    const auto doubt = [&](std::size_t a, std::size_t b) {
        return candidates_.doubtBetween(std::min(a, b), std::max(a, b), settings);
    };
    const double most =
        known ? doubt(c.from, known->from) + doubt(c.to, known->to) - settings.reach : doubt(c.from, c.to);
    const Eigen::Vector3d off = graph_.errorOf(c);
    return off.head<2>().norm() < most && std::abs(off[2]) < settings.maxTurn;
}

VECTORLIB_BODY std::optional<PoseConstraint> LoopCloser::loopWith(std::size_t earlier) {
    ++counts_.tried;
    keys_[earlier].points.unpack(earlier_);
    const GlobalPairMatch &found = match.quickly(earlier_, last_); // other pairs will show the loop
    if (!found.isAccepted())
        return std::nullopt;
    PoseConstraint c;
    c.from = earlier;
    c.to = keys_.size() - 1;
    c.motion = found.solutions[0].pose;
    c.mayBeWrong = true;
    const double xy = settings.matchedXY, alpha = settings.matchedAlpha;
    Eigen::Matrix3d covariance = match.covarianceOf(found.solutions[0]);
    covariance.diagonal() += Eigen::Vector3d(xy * xy, xy * xy, alpha * alpha);
    c.information = covariance.inverse();
    const bool isAllowed = gate_.allows(c, covariance, graph_, candidates_, settings.gate);
    return isAllowed ? std::optional(c) : std::nullopt;
}

VECTORLIB_BODY void LoopCloser::believe(const PoseConstraint &c) {
    const Eigen::Vector3d off = graph_.errorOf(c);
    news_ = news_ || off.head<2>().norm() > settings.newsXY || std::abs(off[2]) > settings.newsAlpha;
    found_ = true;
    ++counts_.closed;
    graph_.constraints.push_back(c);
    if (isLoop(c))
        looped_ = std::max(looped_, c.to);
}

VECTORLIB_BODY void LoopCloser::findLooped() {
    looped_ = 0;
    for (const PoseConstraint &c : graph_.constraints)
        if (isLoop(c) && !c.isRefused())
            looped_ = std::max(looped_, c.to);
}

} // namespace vectorlib
