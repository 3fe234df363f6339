#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/observation/Discrepancy.h"
#include "vectorlib/observation/Frontier.h"
#include "vectorlib/observation/Observer.h"

#include <vector>

namespace vectorlib {

/// Compares what a sensor would see of the static set from a pose with what it saw. Thesis 7.4.2. Keeps its
/// buffers.
class ExpectedViewTest {
public:
    using Segments = std::vector<LineSegment2D<double>>;

    /// The static set, all in one frame. Where it is one scan, seen from `seenFrom`, what that pose did not
    /// see hides what lies behind; a map that grew from many poses has no such place.
    void setFixed(const Segments &fixed, const Transformation2D *seenFrom = nullptr);
    /// The dynamic set, in the sensor's frame.
    void setMoving(const Segments &moving);
    /// For a sensor that stands at `pose` among the static set.
    ViewComparison operator()(const Transformation2D &pose) {
        return compare_(observe_(*fixed_, pose.pose(), obstacles_), observed_);
    }
    /// Under which the dynamic set is seen; radians.
    double observedAngle() const { return observedAngle_; }
    /// The sectors of the last comparison, in the sensor's frame; for pictures.
    const std::vector<SharedSector> &sectors() const { return compare_.sectors(); }

private:
    const Segments *fixed_ = nullptr;
    Observer<double> observe_;
    Frontier frontier_;
    Discrepancy compare_;
    Segments obstacles_;
    std::vector<VisiblePart<double>> observed_;
    double observedAngle_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/ExpectedViewTest.cpp")
