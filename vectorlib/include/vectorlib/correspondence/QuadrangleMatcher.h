#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/correspondence/OverlapSelection.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/similarity/NelderMeadFitter.h"
#include "vectorlib/similarity/QuadrangleCriterion.h"

#include <vector>

namespace vectorlib {

/// What QuadrangleMatcher found.
struct QuadrangleMatch {
    Transformation2D pose; ///< moves the dynamic set onto the static one; the expected one where not accepted
    std::vector<CorrespondencePair> pairs;
    double criterion = 0;  ///< at the pose; m^4
    bool accepted = false; ///< any two pairs are skew: else a direction is open
};

/// The matcher of overview paper 2.2 as a whole, kept as a baseline: OverlapSelection, then the least sum of
/// squared quadrangles by Nelder-Mead. Only long edges fit; short ones may decorate a map. Keeps its buffers
/// between calls.
class QuadrangleMatcher {
public:
    OverlapSelection select;
    NelderMeadFitter fit;
    double skew = 0.17; ///< least angle between the lines of two pairs that are skew; radians

    QuadrangleMatcher() { fit.tolerance = 1e-6; }

    /// `fixed` in the map's frame, `moving` in the sensor's; `expected` moves the second onto the first.
    /// Valid until the next call.
    const QuadrangleMatch &operator()(const OverlapSelection::Segments &fixed,
                                      const OverlapSelection::Segments &moving,
                                      const Transformation2D &expected);

private:
    const LineSegment2D<double> &fixedOf(const CorrespondencePair &pair) const {
        return fixed_[static_cast<std::size_t>(pair.fixed)];
    }
    Vector2D<double> directionOf(std::size_t pair) const { return fixedOf(match_.pairs[pair]).direction(); }
    bool areSkew() const;

    OverlapSelection::Segments fixed_;
    QuadrangleCriterion criterion_;
    QuadrangleMatch match_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/QuadrangleMatcher.cpp")
