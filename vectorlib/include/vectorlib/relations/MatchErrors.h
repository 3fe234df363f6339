#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/observation/Discrepancy.h"
#include "vectorlib/observation/Observer.h"
#include "vectorlib/relations/TypedSegment.h"

#include <cmath>
#include <vector>

namespace vectorlib {

/// How far a pose or a motion is from the true one.
struct PoseError {
    double rotation = 0;    ///< 0 to pi; radians
    double translation = 0; ///< metres
};

/// How far matched segments lie apart. Pose-free thesis 6.3.
struct MatchedArea {
    double error = 0;  ///< between the segments of every pair, seen from the current pose; m^2
    double common = 0; ///< in front of both; m^2

    /// The error area percentage: of the error in the sum of both, 0 to 100; 0 where nothing is shared.
    double percent() const { return error + common > 0 ? 100 * error / (error + common) : 0; }
};

/// The measures of pose-free thesis chapter 6: how well a current scan was laid on a reference. Those of
/// poses need the truth, those of areas do not. Keeps its buffers.
class MatchErrors {
public:
    /// Global rotational and translational error of a scan. 6.2.
    static PoseError ofPose(const Pose2D &estimate, const Pose2D &truth) {
        return {std::abs(wrapAngle(estimate.theta - truth.theta)),
                std::hypot(estimate.x - truth.x, estimate.y - truth.y)};
    }
    /// Rotational and translational error between two scans as published: differences of coordinates in the
    /// frame of the map, so that an old error of the heading counts again in every translation. 6.2.
    static PoseError ofStep(const Pose2D &estimatedReference, const Pose2D &estimatedCurrent,
                            const Pose2D &trueReference, const Pose2D &trueCurrent);
    /// The same in the frame of the reference scan: of this match alone, whatever was wrong before.
    static PoseError ofMotion(const Transformation2D &estimate, const Transformation2D &truth) {
        return {std::abs((estimate.inverse() * truth).alpha()),
                (estimate.translation() - truth.translation()).norm()};
    }

    /// The areas of all pairs at a pose that moves the current scan onto the reference. Pairs of which a
    /// segment is seen from behind or not finite are left out, and those without segments.
    MatchedArea area(const std::vector<CorrespondencePair> &pairs, const std::vector<TypedSegment> &reference,
                     const std::vector<TypedSegment> &current, const Transformation2D &pose);

    /// Between two segments of one direction: of the quadrangle of their ends, or of both triangles where
    /// they cross; m^2.
    static double areaBetween(const LineSegment2D<double> &a, const LineSegment2D<double> &b);

private:
    using Segment = LineSegment2D<double>;

    static double triangle(Vector2D<double> a, Vector2D<double> b, Vector2D<double> c) {
        return std::abs((b - a).cross(c - a)) / 2;
    }

    Discrepancy compare_;
    std::vector<VisiblePart<double>> expected_, observed_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/MatchErrors.cpp")
