#pragma once

#include <vectorlib/io/CarmenLog.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace bench {

using Points = std::vector<vectorlib::Vector2D<float>>;

/// Two scans, counter-clockwise in the frames of their sensors, and the motion between them.
struct ScanPair {
    Points fixed, moving;
    vectorlib::Transformation2D expected;  ///< what the odometry tells, or no motion
    vectorlib::Transformation2D reference; ///< moves the second scan onto the first
    double fieldOfView = 0;                ///< of the scanner: a step for each ray; radians
    std::size_t rays = 0;                  ///< of the scanner

    /// From the first ray to the last, or a full turn; radians.
    double sweep() const {
        const bool isFullTurn = fieldOfView > 1.99 * vectorlib::pi;
        return isFullTurn ? fieldOfView : fieldOfView * double(rays - 1) / double(rays);
    }

    /// Whether a motion is within so many metres and degrees of the reference.
    bool isNear(const vectorlib::Transformation2D &found, double metres, double degrees) const {
        return (found.translation() - reference.translation()).norm() <= metres &&
               std::abs((reference.inverse() * found).alpha()) * 180 / vectorlib::pi <= degrees;
    }
};

using ScanPairs = std::vector<ScanPair>;

/// Every n-th scan of a log with the one that follows in this order; the first so many pairs.
inline ScanPairs pairsOf(const vectorlib::CarmenLog &log, std::size_t every, std::size_t most) {
    ScanPairs pairs;
    for (std::size_t i = 0; i + every < log.scans.size() && pairs.size() < most; i += every) {
        const auto odometry = log.odometryMotion(i, i + every, vectorlib::CarmenOdometryKind::Corrected);
        const vectorlib::CarmenScan &scan = log.scans[i];
        ScanPair p;
        scan.appendPoints(p.fixed);
        log.scans[i + every].appendPoints(p.moving);
        p.expected = odometry.value_or(vectorlib::Transformation2D());
        p.reference = log.referenceMotion(i, i + every);
        p.fieldOfView = scan.angleStep * double(scan.ranges.size());
        p.rays = scan.ranges.size();
        pairs.push_back(std::move(p));
    }
    return pairs;
}

/// At most so many of the second half of the pairs, evenly spread: settings may be chosen on the first.
inline ScanPairs ofSecondHalf(const ScanPairs &all, std::size_t most) {
    const std::size_t first = all.size() / 2, half = all.size() - first, count = std::min(most, half);
    ScanPairs some;
    for (std::size_t k = 0; k < count; ++k)
        some.push_back(all[first + k * half / count]);
    return some;
}

} // namespace bench
