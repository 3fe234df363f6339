#include "vectorlib/correspondence/QuadrangleMatcher.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY const std::vector<CorrespondencePair> &OverlapSelection::operator()(const Segments &fixed,
                                                                                   const Segments &moving) {
    pairs_.clear();
    open_.clear();
    alone_ = 0;
    isTaken_.assign(fixed.size(), 0);
    for (std::size_t m = 0; m < moving.size(); ++m) {
        if (!isLong(moving[m]))
            continue;
        const int partners = partnersOf(fixed, moving[m]);
        alone_ += partners == 0;
        if (partners == 1)
            take(nearest_, m);
        else if (partners > 1)
            open_.push_back(m);
    }
    sure_ = pairs_.size();
    for (const std::size_t m : open_)
        if (partnersOf(fixed, moving[m], true) > 0)
            pairs_.push_back({static_cast<int>(nearest_), static_cast<int>(m)});
    return pairs_;
}

VECTORLIB_BODY void OverlapSelection::take(std::size_t f, std::size_t m) {
    pairs_.push_back({static_cast<int>(f), static_cast<int>(m)});
    isTaken_[f] = 1;
}

VECTORLIB_BODY int OverlapSelection::partnersOf(const Segments &fixed, const LineSegment2D<double> &moving,
                                                bool onlyFree) {
    int partners = 0;
    double least = settings.maxDistance;
    for (std::size_t f = 0; f < fixed.size(); ++f) {
        if (!isLong(fixed[f]) || (onlyFree && isTaken_[f]))
            continue;
        const double sine = std::abs(fixed[f].direction().cross(moving.direction()));
        if (!(sine <= std::sin(std::min(settings.maxAngle, pi / 2))))
            continue;
        const double distance = std::min(fixed[f].distance(moving.begin()), fixed[f].distance(moving.end()));
        if (!(distance <= settings.maxDistance))
            continue;
        ++partners;
        if (distance <= least) {
            least = distance;
            nearest_ = f;
        }
    }
    return partners;
}

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
