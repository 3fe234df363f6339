#include "vectorlib/relations/PoseDifference.h"

#include "vectorlib/relations/Corner.h"

namespace vectorlib {

VECTORLIB_BODY double precisionValue(const LineSegment2D<double> &a, const LineSegment2D<double> &b) {
    const double shorter = std::min(a.length(), b.length());
    return shorter * shorter;
}

VECTORLIB_BODY double rotationalDifference(const std::vector<CorrespondencePair> &pairs,
                                           const std::vector<TypedSegment> &reference,
                                           const std::vector<TypedSegment> &current) {
    double sine = 0, cosine = 0;
    for (const CorrespondencePair &p : pairs) {
        const LineSegment2D<double> &r = reference[static_cast<std::size_t>(p.fixed)].segment;
        const LineSegment2D<double> &c = current[static_cast<std::size_t>(p.moving)].segment;
        const double w = precisionValue(r, c);
        cosine += w * c.direction().dot(r.direction());
        sine += w * c.direction().cross(r.direction());
    }
    return std::atan2(sine, cosine);
}

VECTORLIB_BODY bool poseDifference(const std::vector<CorrespondencePair> &pairs,
                                   const std::vector<TypedSegment> &reference,
                                   const std::vector<TypedSegment> &current, double leastAngle,
                                   Transformation2D &pose) {
    const double alpha = rotationalDifference(pairs, reference, current);
    const Transformation2D turn(0, 0, alpha);
    const double sine = std::sin(leastAngle);
    Vector2D<double> total;
    double weights = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (std::size_t j = i + 1; j < pairs.size(); ++j) {
            const auto at = [](const std::vector<TypedSegment> &set, int k) -> const LineSegment2D<double> & {
                return set[static_cast<std::size_t>(k)].segment;
            };
            const LineSegment2D<double> &k = at(reference, pairs[i].fixed),
                                        &u = at(reference, pairs[j].fixed);
            const LineSegment2D<double> &m = at(current, pairs[i].moving), &v = at(current, pairs[j].moving);
            Vector2D<double> there, here;
            if (!crossing(k, u, sine, there) || !crossing(m, v, sine, here))
                continue;
            const double w = std::min(precisionValue(k, u), precisionValue(m, v));
            total += (there - turn * here) * w;
            weights += w;
        }
    const Vector2D<double> t = weights > 0 ? total / weights : Vector2D<double>();
    pose = Transformation2D(t.x, t.y, alpha);
    return weights > 0;
}

} // namespace vectorlib
