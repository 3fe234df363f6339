#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <vector>

namespace vectorlib {

/// The usable ones of a caller's segments, with their numbers there.
struct NumberedSegments {
    std::vector<LineSegment2D<double>> segments;
    std::vector<int> numbers;

    void clear() {
        segments.clear();
        numbers.clear();
    }
    /// Segments that are not finite or have no length are left out.
    void take(const LineSegment2D<double> &s, int number) {
        if (s.isFinite() && s.direction().squaredNorm() > 0.5) {
            segments.push_back(s);
            numbers.push_back(number);
        }
    }
};

/// Two segments that correspond, by their numbers in the two sets.
struct CorrespondencePair {
    int fixed = 0;  ///< index into the static set
    int moving = 0; ///< index into the dynamic set
};

/// A match of a dynamic set (scan) with a static one (map).
struct Match {
    Transformation2D pose;                 ///< moves the dynamic set onto the static one
    std::vector<CorrespondencePair> pairs; ///< the edges that correspond
    double reliability = 0;                ///< in [0, 1], of the pairs' directions; paper (28)
    double ambiguity = 0;     ///< at the pose, weighted by length; m^2. Thesis (7.44), erratum 10
    double matchedLength = 0; ///< of the dynamic edges in pairs; metres
    double visibleLength = 0; ///< of all dynamic edges; metres
    double rms = 0;           ///< root mean square distance of the paired edges from their lines; metres
    bool accepted = false;    ///< false: the best found, not to be trusted
    /// Of (x, y, alpha) at the pose in the static frame, from the pairs alone: its inverse is their
    /// covariance.
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

} // namespace vectorlib
