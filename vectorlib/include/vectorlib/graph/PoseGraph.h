#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <Eigen/Core>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <cstddef>
#include <functional>
#include <optional>
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

/// A measured motion between two poses of a graph.
struct PoseConstraint {
    std::size_t from = 0, to = 0; ///< numbers of the poses
    Transformation2D motion;      ///< of pose `to` in the frame of pose `from`; metres, radians
    /// Inverse covariance of x, y and alpha, in the frame of pose `from`.
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
    bool mayBeWrong = false; ///< altogether: then it loses its weight where the others contradict it
    double weight = 1;       ///< in [0, 1], found with the poses

    /// Whether the other motions contradict it, so that it counts little.
    bool isRefused() const {
        constexpr double least = 0.25;
        return mayBeWrong && weight < least;
    }
};

/// Settings of PoseGraph::optimise().
struct PoseGraphSettings {
    /// Squared error of a constraint, in squared standard deviations, at which a doubtful one has a quarter
    /// of its weight: of three degrees of freedom one in a hundred has more.
    double doubt = 11.3;
    double narrowing = 2.5; ///< by how much graduation narrows from step to step
    int steps = 10;         ///< most Gauss-Newton steps at the end of graduation
    double enough = 1e-4;   ///< a step that moves no pose farther is the last; metres, radians
};

/// Poses and measured motions between them: finds the poses that fit all motions best, by Gauss-Newton steps
/// with a sparse Cholesky factorization. Motions that may be wrong are weighted by the function of Geman and
/// McClure, from nearly convex to sharp (graduated non-convexity; Yang et al., Graduated non-convexity for
/// robust spatial perception, 2020): a wrong one that the others contradict ends without weight. The first
/// pose stays; a part that nothing connects with it stays where it is.
class PoseGraph {
public:
    PoseGraphSettings settings;
    std::vector<Pose2D> poses; ///< metres, radians
    std::vector<PoseConstraint> constraints;

    /// By how much the poses miss the motion; metres, metres, radians, in the frame of its first pose.
    Eigen::Vector3d errorOf(const PoseConstraint &c) const {
        const Transformation2D is = Transformation2D(poses[c.from]).inverse() * Transformation2D(poses[c.to]);
        const double turn = (c.motion.inverse() * is).alpha();
        return {is.x() - c.motion.x(), is.y() - c.motion.y(), turn};
    }
    /// The same in squared standard deviations.
    double squaredErrorOf(const PoseConstraint &c) const {
        const Eigen::Vector3d e = errorOf(c);
        return e.dot(c.information * e);
    }
    /// Moves the poses and weighs the doubtful constraints. False, and the poses are as before, where the
    /// equations cannot be solved. Poses and motions must be finite, constraints must refer to poses that
    /// there are, and information must be positive definite. progress counts steps, about.
    bool optimise(const std::function<void(std::size_t done, std::size_t all)> &progress = {});

private:
    struct Equations;

    // So wide that the worst motion still counts; those that were found wrong before do so only if they fit
    // now.
    double startWidth() const;
    void weigh(double scale);
    // The farthest that a pose was moved; nothing where there is no solution.
    std::optional<double> step(Equations &e);
    double moveBy(const Eigen::VectorXd &by);
    // The derivatives of the error by both poses, and what they add to the normal equations.
    void add(const PoseConstraint &c, Equations &e) const;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/PoseGraph.cpp")
