#pragma once

#include "vectorlib/relations/TypedSegment.h"

#include <algorithm>
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
                      const Transformation2D &pose) const {
        double length = 0;
        for (const TypedSegment &o : others) {
            const LineSegment2D<double> s = pose * o.segment;
            for (int i = 0; i < samples; ++i) {
                const Vector2D<double> p = s.begin() + (s.end() - s.begin()) * ((i + 0.5) / samples);
                if (isInFront(seen, p))
                    length += s.length() / samples;
            }
        }
        return length;
    }
    // Between the sensor, in the origin, and a segment of its scan, by more than the margin.
    bool isInFront(const std::vector<TypedSegment> &seen, Vector2D<double> p) const {
        return std::any_of(seen.begin(), seen.end(), [&](const TypedSegment &t) {
            const LineSegment2D<double> &s = t.segment;
            return s.begin().cross(p) > 0 && p.cross(s.end()) > 0 && s.across(p) > margin;
        });
    }
};

} // namespace vectorlib
