#pragma once

#include "vectorlib/geometry/Pose2D.h"

#include <functional>
#include <vector>

namespace hermes::vector {

/// When two poses of a drive are the same place met again.
struct RevisitRule {
    double metres = 2;      ///< nearer to each other than this
    double degrees = 60;    ///< turned from each other by less
    std::size_t scans = 40; ///< at least so many scans apart
    double way = 15;        ///< at least so long a way apart; metres
};

/// Calls take with the numbers of the earlier and the later pose of every such pair, in the order of the
/// later. The poses are those of a drive, one after the other; metres, radians.
void forEachRevisit(const std::vector<vectorlib::Pose2D> &drive, const RevisitRule &rule,
                    const std::function<void(std::size_t earlier, std::size_t later)> &take);

} // namespace hermes::vector
