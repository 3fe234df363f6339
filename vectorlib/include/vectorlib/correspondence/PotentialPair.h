#pragma once

#include "vectorlib/correspondence/Match.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

namespace vectorlib {

/// A pair that may correspond, and the line of its perfect transformations: rotation alpha, and shift along
/// the static segment's normal. Thesis (7.19).
struct PotentialPair {
    CorrespondencePair numbers;
    Vector2D<double> normal; ///< of the static segment, towards free space
    double shift = 0;        ///< metres
    double alpha = 0;        ///< radians
    double length = 0;       ///< of the shorter segment, the pair's weight; metres
    LineSegmentRegistration sums;

    PotentialPair(CorrespondencePair pair, const LineSegment2D<double> &fixed,
                  const LineSegment2D<double> &moving, const Stiffness &stiffness)
        : numbers(pair)
        , normal(fixed.normal())
        , shift(fixed.begin().dot(normal) - moving.begin().dot(moving.normal())) // erratum 6
        , alpha(std::atan2(moving.direction().cross(fixed.direction()),
                           moving.direction().dot(fixed.direction())))
        , length(std::min(fixed.length(), moving.length())) {
        sums.stiffness = stiffness;
        sums.add(fixed, moving, length);
    }
};

} // namespace vectorlib
