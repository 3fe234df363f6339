#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/graph/PoseConstraint.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <vector>

namespace vectorlib {

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
    Eigen::Vector3d errorOf(const PoseConstraint &c) const;
    /// The same in squared standard deviations.
    double squaredErrorOf(const PoseConstraint &c) const;
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
