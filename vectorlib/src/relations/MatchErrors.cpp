#include "vectorlib/relations/MatchErrors.h"

namespace vectorlib {

VECTORLIB_BODY PoseError MatchErrors::ofStep(const Pose2D &estimatedReference, const Pose2D &estimatedCurrent,
                                             const Pose2D &trueReference, const Pose2D &trueCurrent) {
    return {std::abs(wrapAngle((estimatedCurrent.theta - estimatedReference.theta) -
                               (trueCurrent.theta - trueReference.theta))),
            std::hypot((estimatedCurrent.x - estimatedReference.x) - (trueCurrent.x - trueReference.x),
                       (estimatedCurrent.y - estimatedReference.y) - (trueCurrent.y - trueReference.y))};
}

VECTORLIB_BODY MatchedArea MatchErrors::area(const std::vector<CorrespondencePair> &pairs,
                                             const std::vector<TypedSegment> &reference,
                                             const std::vector<TypedSegment> &current,
                                             const Transformation2D &pose) {
    const Transformation2D back = pose.inverse();
    MatchedArea sum;
    for (const CorrespondencePair &p : pairs) {
        const auto fixed = static_cast<std::size_t>(p.fixed), moving = static_cast<std::size_t>(p.moving);
        if (p.fixed < 0 || p.moving < 0 || fixed >= reference.size() || moving >= current.size())
            continue;
        const Segment r = back * reference[fixed].segment, &c = current[moving].segment;
        const double between = areaBetween(r, c);
        if (!(r.begin().cross(r.end()) > 0) || !(c.begin().cross(c.end()) > 0) || !std::isfinite(between))
            continue;
        expected_.assign(1, {r, 0});
        observed_.assign(1, {c, 0});
        sum.error += between;
        sum.common += compare_(expected_, observed_).common;
    }
    return sum;
}

VECTORLIB_BODY double MatchErrors::areaBetween(const LineSegment2D<double> &a,
                                               const LineSegment2D<double> &b) {
    const double begin = a.across(b.begin()), end = a.across(b.end());
    if ((begin > 0) == (end > 0))
        return std::abs((b.end() - a.begin()).cross(b.begin() - a.end())) / 2;
    const Vector2D<double> cross = b.begin() + (b.end() - b.begin()) * (begin / (begin - end));
    return triangle(a.begin(), b.begin(), cross) + triangle(a.end(), b.end(), cross);
}

} // namespace vectorlib
