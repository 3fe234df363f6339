#include "vectorlib/graph/LoopCandidates.h"

#include <tuple>

namespace vectorlib {

VECTORLIB_BODY ScanSignature::ScanSignature(PointSpan<float> points) {
    constexpr float nearest = 0.5F, growth = 1.3F; // metres
    const float perStep = 1 / std::log(growth);
    for (const Vector2D<float> &p : points) {
        const float r = std::hypot(p.x, p.y);
        const float step = r > nearest ? std::log(r / nearest) * perStep : 0;
        const float at = step < float(last) ? step : float(last) - 0.001F;
        const auto i = static_cast<std::size_t>(at);
        parts_[i] += float(i + 1) - at;
        parts_[i + 1] += at - float(i);
    }
    const auto count = static_cast<float>(std::max<std::size_t>(1, points.size()));
    for (float &part : parts_)
        part = std::sqrt(part / count);
}

VECTORLIB_BODY float ScanSignature::distance(const ScanSignature &other) const {
    float sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i)
        sum += std::abs(parts_[i] - other.parts_[i]);
    return sum;
}

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
    const double farthest = settings.reach + settings.maxDrift;
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
    if (!(farthest > settings.reach + settings.maxDrift))
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

VECTORLIB_BODY Eigen::Matrix2d LoopCandidates::spreadSince(std::size_t from) const {
    const std::size_t last = scans_.size() - 1;
    const Eigen::Matrix2d turn =
        Eigen::Rotation2Dd(poses_[last].theta - scans_[last].tracked.theta).toRotationMatrix();
    return turn * uncertainty_.between(from, last).topLeftCorner<2, 2>() * turn.transpose();
}

VECTORLIB_BODY std::vector<PoseConstraint> LoopAgreement::add(const PoseConstraint &loop, const End &from,
                                                              const End &to, std::size_t enough) {
    const auto isOver = [&](const Waiting &w) { return to.way - w.to.way > settings.within; };
    waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), isOver), waiting_.end());
    const Waiting next{loop, from, to};
    waiting_.push_back(next);
    std::size_t count = 0;
    double first = 0, counted = 0; // way to those that agree
    std::vector<PoseConstraint> agreed;
    for (const Waiting &w : waiting_) {
        if (!agree(w, next))
            continue;
        if (count == 0)
            first = w.to.way;
        if (count == 0 || w.to.way - counted >= settings.apart) {
            ++count;
            counted = w.to.way;
        }
        agreed.push_back(w.loop);
    }
    if (count < enough || to.way - first < settings.along)
        return {};
    waiting_.erase(
        std::remove_if(waiting_.begin(), waiting_.end(), [&](const Waiting &w) { return agree(w, next); }),
        waiting_.end());
    return agreed;
}

VECTORLIB_BODY bool LoopAgreement::agree(const Waiting &a, const Waiting &b) const {
    const double fromWay = std::abs(b.from.way - a.from.way), toWay = std::abs(b.to.way - a.to.way);
    if (fromWay > settings.within)
        return false;
    const Transformation2D one = a.loop.motion * (a.to.pose.inverse() * b.to.pose);
    const Transformation2D other = (a.from.pose.inverse() * b.from.pose) * b.loop.motion;
    const Transformation2D off = one.inverse() * other;
    return off.translation().norm() <= settings.missXY + settings.missPart * (fromWay + toWay) &&
           std::abs(off.alpha()) <= settings.missAlpha;
}

VECTORLIB_BODY const PoseConstraint *LoopGate::nearestAcross(const PoseConstraint &c, const PoseGraph &graph,
                                                             const LoopCandidates &drive) const {
    if (!isAcross(c.from, c.to))
        return nullptr;
    const PoseConstraint *nearest = nullptr;
    double least = 0;
    for (const PoseConstraint &other : graph.constraints) {
        if (!other.mayBeWrong || other.isRefused() || isAcross(other.from, c.from) ||
            isAcross(other.to, c.to))
            continue;
        const double way = std::abs(drive.scan(other.from).way - drive.scan(c.from).way) +
                           std::abs(drive.scan(other.to).way - drive.scan(c.to).way);
        if (!nearest || way < least) {
            nearest = &other;
            least = way;
        }
    }
    return nearest;
}

VECTORLIB_BODY bool LoopGate::allows(const PoseConstraint &c, const Eigen::Matrix3d &covariance,
                                     const PoseGraph &graph, const LoopCandidates &drive, double most) const {
    const Pose2D &from = drive.scan(c.from).tracked, &to = drive.scan(c.to).tracked;
    const Transformation2D led = Transformation2D(from) * c.motion;
    const Eigen::Matrix3d own = turned(covariance, from.theta);
    if (!isWithin(led, to, drive.uncertainty().between(c.from, c.to) + own, most))
        return false;
    const PoseConstraint *known = nearestAcross(c, graph, drive);
    if (!known)
        return true;
    const Pose2D &knownFrom = drive.scan(known->from).tracked;
    const Transformation2D knownTo = Transformation2D(knownFrom) * known->motion;
    const Pose2D told = (knownTo * drive.led(known->to, c.to)).pose();
    const Eigen::Matrix3d knownSpread =
        at(turned(known->information.inverse(), knownFrom.theta), knownTo.pose(), told);
    const Eigen::Matrix3d spread = own + knownSpread + spreadAt(told, c.from, known->from, drive) +
                                   turned(spreadAt(to, c.to, known->to, drive), told.theta - to.theta);
    return isWithin(led, told, spread, most);
}

VECTORLIB_BODY Eigen::Matrix3d LoopGate::at(const Eigen::Matrix3d &covariance, const Pose2D &pose,
                                            const Pose2D &place) {
    Eigen::Matrix3d arm = Eigen::Matrix3d::Identity();
    arm(0, 2) = pose.y - place.y;
    arm(1, 2) = place.x - pose.x;
    return arm * covariance * arm.transpose();
}

} // namespace vectorlib
