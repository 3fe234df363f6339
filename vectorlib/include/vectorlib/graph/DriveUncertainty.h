#pragma once

#include "vectorlib/geometry/Pose2D.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace vectorlib {

/// How uncertain one pose of a drive is as seen from an earlier one, by the variances of the motions between:
/// those of the rotations turn all that follows about the pose where they happened. From sums along the
/// drive, whatever lies between; poses are as they were tracked, metres and radians.
class DriveUncertainty {
public:
    /// The next pose, and the variances of the motion that led to it: of x and of y, and of the rotation.
    void add(const Pose2D &pose, double varianceXY, double varianceAlpha) {
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
    /// Of x, y and heading of pose `to` in the drive's frame, where pose `from`, an earlier one, is certain.
    Eigen::Matrix3d between(std::size_t from, std::size_t to) const {
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

    /// Memory that it takes, but for what is in reserve.
    std::size_t bytes() const { return sums_.size() * sizeof(Sums); }

private:
    struct Sums {
        Eigen::Vector2d place = Eigen::Vector2d::Zero();
        double xy = 0, alpha = 0;
        Eigen::Vector2d first = Eigen::Vector2d::Zero();  // of the places, by the variances of rotation
        Eigen::Matrix2d second = Eigen::Matrix2d::Zero(); // of their squares
    };

    Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
    std::vector<Sums> sums_;
};

} // namespace vectorlib
