#include "vectorlib/graph/LoopCandidates.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cmath>
#include <tuple>

namespace vectorlib {

VECTORLIB_BODY void LoopCandidates::add(const Scan &scan, const Pose2D &pose) {
    uncertainty_.add(scan.tracked, scan.varianceXY, scan.varianceAlpha);
    scans_.push_back(scan);
    poses_.push_back(pose);
    enter(scans_.size() - 1);
}

VECTORLIB_BODY void LoopCandidates::move(const std::vector<Pose2D> &poses) {
    poses_ = poses;
    grid_.clear();
    for (std::size_t k = 0; k < scans_.size(); ++k)
        enter(k);
}

VECTORLIB_BODY const std::vector<std::size_t> &
LoopCandidates::nearest(const Pose2D &here, std::size_t most, std::size_t sure,
                        const LoopCandidateSettings &settings) {
    const std::size_t last = scans_.size() - 1;
    const Vector2D<double> place(here.x, here.y);
    const double farthest = settings.reach + settings.mostDrift;
    near_.clear();
    grid_.query(place - Vector2D<double>(farthest, farthest), place + Vector2D<double>(farthest, farthest),
                [&](int number) {
                    const auto k = static_cast<std::size_t>(number);
                    const Pose2D &there = poses_[k];
                    const double apart = std::hypot(here.x - there.x, here.y - there.y);
                    if (wayTo(k) >= settings.leastWay &&
                        apart < doubtBetween(std::max(k, sure), last, settings))
                        near_.push_back(
                            {k, apart + 0.5 * std::abs(std::remainder(here.theta - there.theta, 2 * pi))});
                });
    std::sort(near_.begin(), near_.end(), [](const Near &a, const Near &b) {
        return std::tie(a.apart, a.scan) < std::tie(b.apart, b.scan);
    });
    chosen_.clear();
    for (const Near &n : near_) {
        const auto isSamePass = [&](std::size_t other) {
            return std::abs(scans_[other].way - scans_[n.scan].way) < settings.passWay;
        };
        if (chosen_.size() < most && std::none_of(chosen_.begin(), chosen_.end(), isSamePass))
            chosen_.push_back(n.scan);
    }
    return chosen_;
}

VECTORLIB_BODY std::optional<LoopCandidates::Far>
LoopCandidates::far(std::size_t sure, const std::vector<std::size_t> &except,
                    const LoopCandidateSettings &settings) const {
    const std::size_t last = scans_.size() - 1;
    const Eigen::Matrix2d widest = spreadSince(sure);
    const double farthest =
        settings.farDeviations * std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>()
                                               .computeDirect(widest, Eigen::EigenvaluesOnly)
                                               .eigenvalues()[1]);
    if (!(farthest > settings.reach + settings.mostDrift))
        return std::nullopt;
    const Eigen::Matrix2d reach = Eigen::Matrix2d::Identity() * settings.reach * settings.reach;
    const Eigen::Matrix2d sureInformation = (widest + reach).inverse();
    const double most = settings.farDeviations * settings.farDeviations;
    Far found{last, 0};
    float least = 0;
    for (std::size_t k = 0; k < last && wayTo(k) >= settings.leastWay; ++k) {
        const Eigen::Vector2d off(poses_[k].x - poses_[last].x, poses_[k].y - poses_[last].y);
        if (!(off.dot(sureInformation * off) <= most))
            continue;
        if (k > sure && !(off.dot((spreadSince(k) + reach).inverse() * off) <= most))
            continue;
        ++found.among;
        const float unlike = scans_[k].signature.distance(scans_[last].signature);
        if ((found.scan == last || unlike < least) &&
            std::find(except.begin(), except.end(), k) == except.end()) {
            least = unlike;
            found.scan = k;
        }
    }
    return found.scan == last ? std::nullopt : std::optional(found);
}

VECTORLIB_BODY void LoopCandidates::enter(std::size_t k) {
    const Vector2D<double> place(poses_[k].x, poses_[k].y);
    grid_.insert(static_cast<int>(k), {place, place, {1, 0}});
}

VECTORLIB_BODY Eigen::Matrix2d LoopCandidates::spreadSince(std::size_t from) const {
    const std::size_t last = scans_.size() - 1;
    const Eigen::Matrix2d turn =
        Eigen::Rotation2Dd(poses_[last].theta - scans_[last].tracked.theta).toRotationMatrix();
    return turn * uncertainty_.between(from, last).topLeftCorner<2, 2>() * turn.transpose();
}

} // namespace vectorlib
