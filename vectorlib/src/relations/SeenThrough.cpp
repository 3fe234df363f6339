#include "vectorlib/relations/SeenThrough.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY double SeenThrough::operator()(const std::vector<TypedSegment> &reference,
                                              const std::vector<TypedSegment> &current,
                                              const Transformation2D &pose) const {
    return standingIn(reference, current, pose) + standingIn(current, reference, pose.inverse());
}

VECTORLIB_BODY double SeenThrough::standingIn(const std::vector<TypedSegment> &seen,
                                              const std::vector<TypedSegment> &others,
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

VECTORLIB_BODY bool SeenThrough::isInFront(const std::vector<TypedSegment> &seen, Vector2D<double> p) const {
    return std::any_of(seen.begin(), seen.end(), [&](const TypedSegment &t) {
        const LineSegment2D<double> &s = t.segment;
        return s.begin().cross(p) > 0 && p.cross(s.end()) > 0 && s.across(p) > margin;
    });
}

} // namespace vectorlib
