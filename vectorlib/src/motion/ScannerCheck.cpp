#include "vectorlib/motion/ScannerCheck.h"
#include "vectorlib/geometry/Angle.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY void ScannerCheck::add(const Transformation2D &odometry, const Transformation2D &scans,
                                      double seconds) {
    const double turn = odometry.alpha(), found = scans.alpha(), size = std::abs(turn);
    const Vector2D<double> way = odometry.translation(), seen = scans.translation();
    const double length = way.norm();
    if (size > least_rad) { // one that is neither tells nothing
        against_rad_ += std::abs(found + turn) < alike_rad * size ? size : 0;
        with_rad_ += std::abs(found - turn) < alike_rad * size ? size : 0;
    }
    if (length > least_m && size < straight_rad_per_m * length) {
        way_m_ += length;
        lengths_ += length * seen.norm();
        directions_ = directions_ + Vector2D<double>(way.dot(seen), way.cross(seen));
    }
    const double more = found - turn;
    if (!(seconds > 0) || std::abs(more) > wild * size + wild_rad)
        return;
    const Eigen::Vector4d x(turn, length, size, turn * turn / seconds);
    h_ += x * x.transpose();
    g_ += x * more;
    squares_ += more * more;
    turns_ += size > least_rad;
}

VECTORLIB_BODY std::optional<double> ScannerCheck::turned() const {
    const double angle = std::atan2(directions_.y, directions_.x);
    // The scan's way is the odometry's, turned back by what the mount is turned.
    if (isMirrored() || way_m_ < enough_m || directions_.norm() < alike * lengths_ ||
        std::abs(angle) < leastTurned)
        return std::nullopt;
    return -angle;
}

VECTORLIB_BODY std::optional<double> ScannerCheck::secondsPerTurn() const {
    if (turns_ < enoughTurns)
        return std::nullopt;
    // Standard deviations of what is known before: of the odometry's scale (1), of how askew it drives
    // (rad/m), of its slip, and of T / 2 pi (s).
    static const Eigen::Array4d usual(0.05, 0.02, 0.005, 1);
    const double noise = std::max(1e-6, squares_ / turns_);
    Eigen::Matrix4d h = h_;
    h.diagonal() += (noise / usual.square()).matrix();
    const Eigen::Matrix4d inverse = h.inverse();
    const Eigen::Vector4d b = inverse * g_;
    const double rest = std::max(1e-8, (squares_ - b.dot(g_)) / turns_);
    if (!(std::abs(b(3)) > sure * std::sqrt(rest * inverse(3, 3))))
        return std::nullopt;
    return -2 * pi * b(3);
}

} // namespace vectorlib
