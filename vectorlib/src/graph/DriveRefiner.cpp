#include "vectorlib/graph/DriveRefiner.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace vectorlib {

VECTORLIB_BODY void DriveRefiner::add(PointSpan<float> points, const Transformation2D &tracked) {
    if (!keys_.empty()) {
        since_ = since_ * tracked;
        way_ += tracked.translation().norm();
        if (const auto c = measured({keys_.back().scan, keyPoints_}, {scans_, points}, since_))
            nexts_.push_back(*c);
    }
    if (keys_.empty() || since_.translation().norm() >= settings.keyWay ||
        std::abs(since_.alpha()) >= settings.keyTurn) {
        keys_.push_back({scans_, way_, PackedPoints(points)});
        keyPoints_.assign(points.begin(), points.end());
        since_ = Transformation2D();
    }
    ++scans_;
}

VECTORLIB_BODY bool
DriveRefiner::operator()(std::vector<Pose2D> &poses, const std::vector<PoseConstraint> &loops,
                         const std::function<void(std::size_t done, std::size_t all)> &progress) {
    if (poses.size() != scans_)
        return false;
    graph_.poses = poses;
    graph_.constraints.clear();
    keepWay();
    for (const PoseConstraint &c : nexts_)
        take(c);
    for (PoseConstraint c : loops) {
        c.information *= c.weight;
        graph_.constraints.push_back(c);
    }
    comparePasses(progress);
    if (!graph_.optimise())
        return false;
    poses = graph_.poses;
    return true;
}

VECTORLIB_BODY std::optional<PoseConstraint> DriveRefiner::measured(const Scan &from, const Scan &to,
                                                                    const Transformation2D &expected) {
    Expectation expectation;
    expectation.pose = expected;
    match.start(from.points, to.points);
    const Transformation2D motion = match(expected, expectation);
    const PointAgreement agreement = match.agreement(motion);
    if (!(agreement.explained() >= settings.minExplained &&
          agreement.contradicted() <= settings.maxContradicted))
        return std::nullopt;
    const double xy = settings.matchedXY, alpha = settings.matchedAlpha;
    Eigen::Matrix3d covariance = tellCovariance(match, motion);
    covariance.diagonal() += Eigen::Vector3d(xy * xy, xy * xy, alpha * alpha);
    return PoseConstraint{from.number, to.number, motion, covariance.inverse(), true, 1};
}

VECTORLIB_BODY void DriveRefiner::take(const PoseConstraint &c) {
    const Eigen::Vector3d off = graph_.errorOf(c);
    if (off.head<2>().norm() <= settings.maxXY && std::abs(off[2]) <= settings.maxAlpha)
        graph_.constraints.push_back(c);
}

VECTORLIB_BODY void DriveRefiner::keepWay() {
    constexpr double least = 1e-3; // metres, radians; of standing, too
    for (std::size_t to = 1; to < scans_; ++to) {
        const Transformation2D motion = motionBetween(to - 1, to);
        const double way = motion.translation().norm(), turn = std::abs(motion.alpha());
        const double xy = std::hypot(least, settings.keptXY * std::sqrt(way));
        const double alpha =
            std::hypot(least, settings.keptAlpha * std::sqrt(way), settings.keptTurn * std::sqrt(turn));
        graph_.constraints.push_back(
            {to - 1, to, motion,
             Eigen::Vector3d(1 / (xy * xy), 1 / (xy * xy), 1 / (alpha * alpha)).asDiagonal(), false, 1});
    }
}

VECTORLIB_BODY void
DriveRefiner::comparePasses(const std::function<void(std::size_t, std::size_t)> &progress) {
    SegmentGrid grid(settings.reach);
    for (std::size_t k = 0; k < keys_.size(); ++k) {
        const Pose2D &here = graph_.poses[keys_[k].scan];
        const Vector2D<double> place(here.x, here.y);
        compareWithNearest(k, grid);
        grid.insert(static_cast<int>(k), {place, place, {1, 0}});
        if (progress)
            progress(k + 1, keys_.size());
    }
}

VECTORLIB_BODY void DriveRefiner::compareWithNearest(std::size_t key, SegmentGrid &grid) {
    findCandidates(key, grid);
    passes_.clear();
    keys_[key].points.unpack(keyPoints_);
    for (const Candidate &c : candidates_) {
        const Key &earlier = keys_[c.key], &later = keys_[key];
        const auto isSamePass = [&](double way) { return std::abs(way - earlier.way) < settings.passWay; };
        if (std::any_of(passes_.begin(), passes_.end(), isSamePass))
            continue;
        passes_.push_back(earlier.way);
        earlier.points.unpack(earlier_);
        if (const auto found = measured({earlier.scan, earlier_}, {later.scan, keyPoints_},
                                        motionBetween(earlier.scan, later.scan)))
            take(*found);
        if (passes_.size() == settings.perScan)
            break;
    }
}

VECTORLIB_BODY void DriveRefiner::findCandidates(std::size_t key, SegmentGrid &grid) {
    const Pose2D &here = graph_.poses[keys_[key].scan];
    const Vector2D<double> place(here.x, here.y), reach(settings.reach, settings.reach);
    candidates_.clear();
    grid.query(place - reach, place + reach, [&](int number) {
        const auto k = static_cast<std::size_t>(number);
        const Pose2D &there = graph_.poses[keys_[k].scan];
        const double apart = std::hypot(here.x - there.x, here.y - there.y);
        const double turn = std::abs(std::remainder(here.theta - there.theta, 2 * pi));
        if (apart < settings.reach && turn < settings.maxTurn &&
            keys_[key].way - keys_[k].way >= settings.leastWay)
            candidates_.push_back({apart + 0.5 * turn, k});
    });
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate &a, const Candidate &b) {
        return std::tie(a.apart, a.key) < std::tie(b.apart, b.key);
    });
}

} // namespace vectorlib
