#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/observation/Observer.h"

#include <vector>

namespace vectorlib {

/// The border between what a view has explored and what it has not: from the end of each visible part to the
/// begin of the next. Behind it lies the shadow of the nearer of the two. Directions in which nothing was
/// seen under more than `widestGap` are unexplored down to the sensor. Thesis 7.4.2, third rule.
///
/// `view` is that of an Observer with a full turn; the frontier is in its frame, counter-clockwise. An empty
/// view has explored nothing and has no frontier.
class Frontier {
public:
    double widestGap = pi / 6; ///< radians

    /// The frontier of a view; valid until the next call.
    const std::vector<LineSegment2D<double>> &operator()(const std::vector<VisiblePart<double>> &view);

private:
    void close(Vector2D<double> end, Vector2D<double> begin);

    std::vector<LineSegment2D<double>> segments_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/observation/Frontier.cpp")
