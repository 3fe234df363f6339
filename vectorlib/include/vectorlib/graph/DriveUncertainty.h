#pragma once

#include "vectorlib/Body.h"
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
    void add(const Pose2D &pose, double varianceXY, double varianceAlpha);
    /// Of x, y and heading of pose `to` in the drive's frame, where pose `from`, an earlier one, is certain.
    Eigen::Matrix3d between(std::size_t from, std::size_t to) const;

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

#include VECTORLIB_BODIES("vectorlib/src/graph/DriveUncertainty.cpp")
