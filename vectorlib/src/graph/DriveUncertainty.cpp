#include "vectorlib/graph/DriveUncertainty.h"

namespace vectorlib {

VECTORLIB_BODY void DriveUncertainty::add(const Pose2D &pose, double varianceXY, double varianceAlpha) {
    if (sums_.empty())
        origin_ = {pose.x, pose.y};
    Sums s = sums_.empty() ? Sums() : sums_.back();
    const Eigen::Vector2d p = Eigen::Vector2d(pose.x, pose.y) - origin_; // squares stay small
    s.place = p;
    s.xy += varianceXY;
    s.alpha += varianceAlpha;
    s.first += varianceAlpha * p;
    s.second += varianceAlpha * p * p.transpose();
    sums_.push_back(s);
}

VECTORLIB_BODY Eigen::Matrix3d DriveUncertainty::between(std::size_t from, std::size_t to) const {
    const Sums &a = sums_[from], &b = sums_[to];
    const double alpha = b.alpha - a.alpha;
    const Eigen::Vector2d p = b.place, first = b.first - a.first;
    const Eigen::Matrix2d arms = b.second - a.second - first * p.transpose() - p * first.transpose() +
                                 alpha * p * p.transpose(); // squares of the ways from there to `to`
    const Eigen::Vector2d arm = alpha * p - first;
    Eigen::Matrix3d c;
    c << arms(1, 1) + b.xy - a.xy, -arms(0, 1), -arm.y(), //
        -arms(0, 1), arms(0, 0) + b.xy - a.xy, arm.x(),   //
        -arm.y(), arm.x(), alpha;
    return c;
}

} // namespace vectorlib
