#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/RelationSet.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vectorlib {

/// How much of one scan stands where the other has looked through: what is between a sensor and a segment
/// that it sees is free. Two rooms that are alike but not the same contradict each other so.
class SeenThrough {
public:
    double margin = 0.25; ///< how far in front of the other's segment counts; metres
    int samples = 4;      ///< along each segment

    /// Length of the segments of either scan that stand in the free space of the other when the pose brings
    /// the current scan onto the reference; metres.
    double operator()(const std::vector<TypedSegment> &reference, const std::vector<TypedSegment> &current,
                      const Transformation2D &pose) const {
        return standingIn(reference, current, pose) + standingIn(current, reference, pose.inverse());
    }

private:
    double standingIn(const std::vector<TypedSegment> &seen, const std::vector<TypedSegment> &others,
                      const Transformation2D &pose) const;
    // Between the sensor, in the origin, and a segment of its scan, by more than the margin.
    bool isInFront(const std::vector<TypedSegment> &seen, Vector2D<double> p) const;
};

/// The segments of a scan that take part in a match, with their relations. Left out are those that are not
/// finite, lie beyond 1000 km or have no length, and of more than the bound all but the longest; the order
/// stays. An angle edge with the next segment counts only where the two meet: in a set out of order they do
/// not. Memory for n segments: n numbers, and what the bound needs. Keeps its buffers.
class RelationScan {
public:
    /// Takes the segments of a scan in their order.
    void build(const std::vector<TypedSegment> &all, const RelationSettings &settings);
    const std::vector<TypedSegment> &segments() const { return segments_; }
    const RelationSet &relations() const { return relations_; }
    std::size_t leftOut() const { return leftOut_; }
    /// The number of a segment as it was given.
    int given(int number) const { return static_cast<int>(numbers_[static_cast<std::size_t>(number)]); }

private:
    static constexpr double meeting = 0.01; // between ends that are one angle edge; metres

    static bool isWithinReach(Vector2D<double> p) { return std::max(std::abs(p.x), std::abs(p.y)) < 1e6; }

    void chooseUsable(const std::vector<TypedSegment> &all);
    void keepLongest(const std::vector<TypedSegment> &all, std::size_t most);

    std::vector<std::size_t> numbers_;
    std::vector<TypedSegment> segments_;
    RelationSet relations_;
    std::size_t leftOut_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/RelationScan.cpp")
