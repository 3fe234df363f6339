#include "vectorlib/graph/LoopGate.h"

#include <Eigen/Dense>

#include <cmath>

namespace vectorlib {

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

VECTORLIB_BODY bool LoopGate::isWithin(const Transformation2D &led, const Pose2D &to,
                                       const Eigen::Matrix3d &spread, double most) {
    const Eigen::Vector3d off(led.x() - to.x, led.y() - to.y, std::remainder(led.alpha() - to.theta, 2 * pi));
    return off.dot(spread.ldlt().solve(off)) <= most;
}

VECTORLIB_BODY Eigen::Matrix3d LoopGate::turned(const Eigen::Matrix3d &covariance, double angle) {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(angle).toRotationMatrix();
    return turn * covariance * turn.transpose();
}

VECTORLIB_BODY Eigen::Matrix3d LoopGate::at(const Eigen::Matrix3d &covariance, const Pose2D &pose,
                                            const Pose2D &place) {
    Eigen::Matrix3d arm = Eigen::Matrix3d::Identity();
    arm(0, 2) = pose.y - place.y;
    arm(1, 2) = place.x - pose.x;
    return arm * covariance * arm.transpose();
}

VECTORLIB_BODY Eigen::Matrix3d LoopGate::spreadAt(const Pose2D &place, std::size_t a, std::size_t b,
                                                  const LoopCandidates &drive) {
    const std::size_t late = std::max(a, b);
    return at(drive.uncertainty().between(std::min(a, b), late), drive.scan(late).tracked, place);
}

} // namespace vectorlib
