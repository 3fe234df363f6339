#pragma once

#include "tests/bench/PairRows.h"

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/slam/CICP.h>

namespace bench {

inline vectorlib::Transformation2D motionOf(const mrpt::poses::CPose2D &pose) {
    return {pose.x(), pose.y(), pose.phi()};
}

inline void fill(mrpt::maps::CSimplePointsMap &map, const Points &points) {
    map.clear();
    map.reserve(points.size());
    for (const auto &p : points)
        map.insertPointFast(p.x, p.y);
    map.mark_as_modified();
}

/// Iterative closest points of MRPT (libmrpt-slam-dev) with its default settings. It has no search of its
/// own: it starts from what the odometry tells, or from no motion. Its maps of points are made within the
/// time measured.
template <bool knowsOdometry>
class MrptIcp {
public:
    void prepare(const ScanPair &) {}
    Answer operator()(const ScanPair &pair) {
        return {from(pair, knowsOdometry ? pair.expected : vectorlib::Transformation2D()), true};
    }
    vectorlib::Transformation2D from(const ScanPair &pair, const vectorlib::Transformation2D &guess) {
        fill(fixed_, pair.fixed);
        fill(moving_, pair.moving);
        mrpt::poses::CPose2D found;
        align_.Align(&fixed_, &moving_, {guess.x(), guess.y(), guess.alpha()})->getMean(found);
        return motionOf(found);
    }

private:
    mrpt::slam::CICP align_;
    mrpt::maps::CSimplePointsMap fixed_, moving_;
};

} // namespace bench
