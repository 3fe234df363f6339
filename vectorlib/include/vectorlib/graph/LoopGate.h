#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/graph/LoopCandidates.h"
#include "vectorlib/graph/PoseConstraint.h"
#include "vectorlib/graph/PoseGraph.h"

#include <Eigen/Core>

#include <algorithm>
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
                                        const LoopCandidates &drive) const;
    /// Whether a loop with that covariance, in the frame of its first scan, misses where the drive led by no
    /// more squared standard deviations than `most`.
    bool allows(const PoseConstraint &c, const Eigen::Matrix3d &covariance, const PoseGraph &graph,
                const LoopCandidates &drive, double most) const;

private:
    // How often the sensor was put elsewhere up to that scan.
    std::ptrdiff_t part(std::size_t scan) const {
        return std::upper_bound(placed_.begin(), placed_.end(), scan) - placed_.begin();
    }
    static bool isWithin(const Transformation2D &led, const Pose2D &to, const Eigen::Matrix3d &spread,
                         double most);
    // A covariance in a frame that is turned.
    static Eigen::Matrix3d turned(const Eigen::Matrix3d &covariance, double angle);
    // The covariance of a pose, as that of `place`, which is rigid with it.
    static Eigen::Matrix3d at(const Eigen::Matrix3d &covariance, const Pose2D &pose, const Pose2D &place);
    // Of `place`, which is rigid with one of two scans, where the other one is certain.
    static Eigen::Matrix3d spreadAt(const Pose2D &place, std::size_t a, std::size_t b,
                                    const LoopCandidates &drive);

    std::vector<std::size_t> placed_; // scans to which the sensor was put, ascending
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/LoopGate.cpp")
