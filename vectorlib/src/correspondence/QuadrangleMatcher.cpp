#include "vectorlib/correspondence/QuadrangleMatcher.h"

namespace vectorlib {

VECTORLIB_BODY const QuadrangleMatch &QuadrangleMatcher::operator()(const OverlapSelection::Segments &fixed,
                                                                    const OverlapSelection::Segments &moving,
                                                                    const Transformation2D &expected) {
    // In the expected sensor frame, as elsewhere (erratum 13).
    const Transformation2D toLocal = expected.inverse();
    fixed_.clear();
    for (const LineSegment2D<double> &segment : fixed)
        fixed_.push_back(toLocal * segment);
    match_.pairs = select(fixed_, moving);
    match_.accepted = areSkew();
    criterion_.clear();
    for (const CorrespondencePair &pair : match_.pairs)
        criterion_.add({fixedOf(pair), moving[static_cast<std::size_t>(pair.moving)], 1});
    const Transformation2D found = match_.accepted ? fit(criterion_, Transformation2D()) : Transformation2D();
    match_.criterion = criterion_(found);
    match_.pose = expected * found;
    return match_;
}

VECTORLIB_BODY bool QuadrangleMatcher::areSkew() const {
    const double sine = std::sin(skew);
    for (std::size_t i = 0; i < match_.pairs.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (std::abs(directionOf(i).cross(directionOf(j))) >= sine)
                return true;
    return false;
}

} // namespace vectorlib
