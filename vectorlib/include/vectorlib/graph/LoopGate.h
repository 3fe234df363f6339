#pragma once

#include "vectorlib/graph/LoopCandidates.h"
#include "vectorlib/graph/PoseGraph.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vectorlib {

/// Whether the drive allows a loop. Where rooms are alike, loops that are off by the same way agree with each
/// other: each has to agree with the drive alone first. Where the sensor was put elsewhere on the way, which
/// tells next to nothing, it has to agree with the nearest loop that leads across, too, and with the drive
/// from there. Scans have the numbers of LoopCandidates and of the graph's poses.
class LoopGate {
public:
    /// The sensor was put elsewhere, to that scan: a later one than those before.
    void addPlaced(std::size_t scan) { placed_.push_back(scan); }
    void clear() { placed_.clear(); }
    /// Whether the sensor was put elsewhere between two scans.
    bool isAcross(std::size_t from, std::size_t to) const { return part(from) != part(to); }
    /// Where it was: of the believed loops between the same two parts the one nearest by its ways; null where
    /// there is none.
    const PoseConstraint *nearestAcross(const PoseConstraint &c, const PoseGraph &graph,
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
    /// Whether a loop with that covariance, in the frame of its first scan, misses where the drive led by no
    /// more squared standard deviations than `most`.
    bool allows(const PoseConstraint &c, const Eigen::Matrix3d &covariance, const PoseGraph &graph,
                const LoopCandidates &drive, double most) const {
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

private:
    // How often the sensor was put elsewhere up to that scan.
    std::ptrdiff_t part(std::size_t scan) const {
        return std::upper_bound(placed_.begin(), placed_.end(), scan) - placed_.begin();
    }
    static bool isWithin(const Transformation2D &led, const Pose2D &to, const Eigen::Matrix3d &spread,
                         double most) {
        const Eigen::Vector3d off(led.x() - to.x, led.y() - to.y,
                                  std::remainder(led.alpha() - to.theta, 2 * pi));
        return off.dot(spread.ldlt().solve(off)) <= most;
    }
    // A covariance in a frame that is turned.
    static Eigen::Matrix3d turned(const Eigen::Matrix3d &covariance, double angle) {
        Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
        turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(angle).toRotationMatrix();
        return turn * covariance * turn.transpose();
    }
    // The covariance of a pose, as that of `place`, which is rigid with it.
    static Eigen::Matrix3d at(const Eigen::Matrix3d &covariance, const Pose2D &pose, const Pose2D &place) {
        Eigen::Matrix3d arm = Eigen::Matrix3d::Identity();
        arm(0, 2) = pose.y - place.y;
        arm(1, 2) = place.x - pose.x;
        return arm * covariance * arm.transpose();
    }
    // Of `place`, which is rigid with one of two scans, where the other one is certain.
    static Eigen::Matrix3d spreadAt(const Pose2D &place, std::size_t a, std::size_t b,
                                    const LoopCandidates &drive) {
        const std::size_t late = std::max(a, b);
        return at(drive.uncertainty().between(std::min(a, b), late), drive.scan(late).tracked, place);
    }

    std::vector<std::size_t> placed_; // scans to which the sensor was put, ascending
};

} // namespace vectorlib
