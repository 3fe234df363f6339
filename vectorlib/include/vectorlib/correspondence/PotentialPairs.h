#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <cmath>

namespace vectorlib {

/// The permitted set of transformations around the expected one; metres and radians. Defaults of the thesis
/// appendices.
struct PermittedError {
    double dx = 1.2;
    double dy = 1.2;
    double dalpha = 1.26;

    /// Whether a transformation is in the set, whose centre is the identity.
    bool holds(const Transformation2D &t) const {
        return std::abs(t.x()) <= dx && std::abs(t.y()) <= dy && std::abs(t.alpha()) <= dalpha;
    }
};

/// Whether some transformation of the permitted set, centred at the identity, brings `moving` onto the line
/// of `fixed` so that they share at least one point. Thesis 7.4.1 with (7.19): the perfect transformations of
/// the pair form a line P + tau v in the space of translations; it is clipped by the box |x| <= dx, |y| <= dy
/// and by the overlap, exactly.
bool mayCorrespond(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving,
                   const PermittedError &permitted);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/PotentialPairs.cpp")
