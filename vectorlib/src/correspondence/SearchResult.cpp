#include "vectorlib/correspondence/SearchResult.h"
#include "vectorlib/geometry/SmallMatrix.h"

namespace vectorlib {

VECTORLIB_BODY const char *describe(Fault fault) {
    static constexpr const char *texts[] = {"accepted",
                                            "the directions of its pairs are too much alike to fix the place",
                                            "its pairs contradict each other",
                                            "too little of the dynamic set has partners",
                                            "too little of the static set would be seen from there",
                                            "what would be seen from there differs from what was seen",
                                            "its transformation is not in the permitted set"};
    return texts[static_cast<int>(fault)]; // in the order of the enumeration
}

VECTORLIB_BODY const char *describe(SearchOutcome outcome) {
    static constexpr const char *texts[] = {
        "every combination was considered",
        "the bound on combinations ended the search: there may be better solutions",
        ("the expected transformation, a threshold or a bound is negative, zero where it must not be, or "
         "not finite"), // one text
        "no usable segment in the static set within reach",
        "no usable segment in the dynamic set",
        "no permitted transformation brings any two segments together",
        "more pairs of segments near each other than the bounds on pairs: permit less motion",
        "all potential pairs are parallel: the shift along them is not known",
        "no two directions agree on a transformation"};
    return texts[static_cast<int>(outcome)]; // in the order of the enumeration
}

VECTORLIB_BODY std::optional<Eigen::Matrix3d>
SolutionCovariance::operator()(const Solution &solution, const MeasuredSegments &fixed,
                               const MeasuredSegments &moving) const {
    if (!(solution.reliability > 0))
        return std::nullopt;
    std::vector<Effect> effects;
    Eigen::Matrix3d sums = Eigen::Matrix3d::Zero(), spread = Eigen::Matrix3d::Zero();
    for (const CorrespondencePair &p : solution.pairs) {
        if (!isKnown(p.fixed, fixed) || !isKnown(p.moving, moving))
            return std::nullopt;
        effects.push_back(
            effectOf(at(fixed.segments, p.fixed), at(moving.segments, p.moving), solution.pose, sums));
    }
    // A line in two pairs errs in both alike.
    for (std::size_t a = 0; a < effects.size(); ++a)
        for (std::size_t b = 0; b < effects.size(); ++b) {
            const CorrespondencePair &p = solution.pairs[a], &q = solution.pairs[b];
            if (p.fixed == q.fixed)
                spread += product(effects[a].byFixed,
                                  at(fixed.lines, p.fixed).ofSegment(at(fixed.segments, p.fixed)),
                                  effects[b].byFixed);
            if (p.moving == q.moving)
                spread += product(effects[a].byMoving,
                                  at(moving.lines, p.moving).ofSegment(at(moving.segments, p.moving)),
                                  effects[b].byMoving);
        }
    const Eigen::Matrix3d inverse = sums.inverse(); // symmetric
    const Eigen::Matrix3d covariance = product(inverse, spread, inverse);
    return covariance.allFinite() ? std::optional<Eigen::Matrix3d>(covariance) : std::nullopt;
}

template <typename T>
const T &SolutionCovariance::at(const std::vector<T> &list, int i) {
    return list[static_cast<std::size_t>(i)];
}

VECTORLIB_BODY SolutionCovariance::Effect SolutionCovariance::effectOf(const LineSegment2D<double> &fixed,
                                                                       const LineSegment2D<double> &moving,
                                                                       const Transformation2D &pose,
                                                                       Eigen::Matrix3d &sums) {
    const double length = moving.length(), moment = length * length * length / 12;
    const Vector2D<double> n = fixed.normal(), v = fixed.direction(), middle = pose * moving.middle();
    const Eigen::Vector3d j(n.x, n.y, v.dot(middle - pose.translation()));
    sums += square(length, j);
    sums(2, 2) += moment;
    const auto effect = [&](double u) {
        Eigen::Matrix<double, 3, 2> by;
        for (int i = 0; i < 3; ++i) {
            by(i, 0) = u * length * j(i);
            by(i, 1) = length * j(i);
        }
        by(2, 0) += moment;
        return by;
    };
    return {effect(v.dot(middle)), effect(moving.direction().dot(moving.middle()))};
}

} // namespace vectorlib
