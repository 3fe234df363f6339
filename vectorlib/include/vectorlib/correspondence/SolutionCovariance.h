#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/SearchResult.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/tls/LineCovariance.h"

#include <optional>
#include <vector>

namespace vectorlib {

/// Segments and how sure their lines are, one covariance a segment, in one frame.
struct MeasuredSegments {
    std::vector<LineSegment2D<double>> segments;
    std::vector<LineCovariance> lines;
};

/// How sure the pose of a solution is, from how sure its lines are: first order, for lines whose errors are
/// independent and small. The pose is where the points of the dynamic segments lie on the static lines best
/// (PairSelection); it is this estimate that is differentiated, where RegistrationCovariance does the same
/// for the one-step registration.
class SolutionCovariance {
public:
    /// Rows and columns x, y (metres), alpha (radians), in the static frame. Nothing where all lines are
    /// parallel, where a covariance is not valid, and for pairs that are not among the segments.
    std::optional<Eigen::Matrix3d> operator()(const Solution &solution, const MeasuredSegments &fixed,
                                              const MeasuredSegments &moving) const;

private:
    /// What the angle and the offset p of the lines of a pair add to the right side of the normal equations.
    struct Effect {
        Eigen::Matrix<double, 3, 2> byFixed, byMoving;
    };

    template <typename T>
    static const T &at(const std::vector<T> &list, int i);
    static bool isKnown(int i, const MeasuredSegments &set);

    // Over the points of the dynamic segment, s metres from its middle, the residual across the static line
    // changes with the pose by j + s k, and with a line's angle and offset by u + s and 1, where u is the
    // place of the middle along the line. The integrals of 1, s, s^2 are L, 0, L^3 / 12.
    static Effect effectOf(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving,
                           const Transformation2D &pose, Eigen::Matrix3d &sums);
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/SolutionCovariance.cpp")
