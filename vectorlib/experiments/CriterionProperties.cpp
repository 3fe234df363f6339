#include "vectorlib/experiments/CriterionProperties.h"

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/similarity/EdgeSetComparator.h"
#include "vectorlib/similarity/HausdorffDistances.h"
#include "vectorlib/similarity/NelderMeadFitter.h"

#include <Eigen/Dense>

#include <cmath>
#include <random>

namespace hermes::experiments {

namespace {

using Segment = vectorlib::LineSegment2D<double>;
using Point = vectorlib::Vector2D<double>;
using vectorlib::pi;
using vectorlib::Transformation2D;

double squaredQuadrangle(const Segment &fixed, const Segment &moving) {
    const double area = vectorlib::quadrangleArea(fixed, moving);
    return area * area;
}

/// Random segments, and whether one criterion has a property in one trial with them.
class Trial {
public:
    Trial(const SegmentCriterion &criterion, std::mt19937_64 &random)
        : criterion_(criterion)
        , random_(random)
        , fixed_(any())
        , moving_(any()) {}

    bool isZeroOnOneLine() { return of(fixed_, onLine()) < 1e-9; }
    bool isAboveZeroElsewhere() {
        const Segment beside = Transformation2D(0, 0, fixedAngle()) * Transformation2D(0, 1, 0) *
                               Transformation2D(0, 0, -fixedAngle()) * onLine();
        return of(fixed_, moving_) > 1e-9 && of(fixed_, beside) > 1e-9 && of(fixed_, turned(onLine())) > 1e-9;
    }
    bool ignoresSliding() {
        const Point way = fixed_.direction() * between(-5, 5);
        return same(of(fixed_, Transformation2D(way.x, way.y, 0) * moving_), of(fixed_, moving_));
    }
    bool ignoresMotionOfBoth() {
        const Transformation2D t = motion();
        return same(of(t * fixed_, t * moving_), of(fixed_, moving_));
    }
    bool seesMotionAsideTurnAndLength() {
        const double before = of(fixed_, moving_);
        const Point aside = fixed_.normal() * 0.1;
        return !same(of(fixed_, Transformation2D(aside.x, aside.y, 0) * moving_), before) &&
               !same(of(fixed_, turned(moving_)), before) &&
               !same(of(fixed_, moving_.part(0, 1.1 * moving_.length())), before);
    }
    bool growsWithTheAngle() { // figure 7.3, up to a right angle
        const double shift = between(0, 2), angle = between(0.01, pi / 2 - 0.02);
        return ofUnit(shift, 1, angle + 0.01) > ofUnit(shift, 1, angle);
    }
    bool growsWithTheLength() { // figure 7.4
        const double length = between(0.01, 2), angle = between(0.1, pi - 0.1);
        return ofUnit(0, length + 0.01, angle) > ofUnit(0, length, angle);
    }
    bool keepsItsShapeAtSmallLengths() { // figure 7.4, sub-plot
        const double angle = between(0.1, pi - 0.1);
        const auto shape = [&](double length) {
            return ofUnit(0, length, angle) / ofUnit(0, length, pi / 2);
        };
        return std::abs(shape(1e-3) / shape(1) - 1) < 0.01;
    }
    bool isSmooth() { // the largest second difference falls by 16 with a quarter of the step
        const auto largestBend = [&](int steps) {
            const auto at = [&](int i) {
                return of(fixed_, Transformation2D(0, 0, 2 * pi * i / steps) * moving_);
            };
            double largest = 0;
            for (int i = 0; i < steps; ++i)
                largest = std::max(largest, std::abs(at(i - 1) - 2 * at(i) + at(i + 1)));
            return largest;
        };
        return largestBend(500) > 12 * largestBend(2000);
    }
    bool isSummed() { // as (7.18): a quadratic form of (cos, sin, x, y, 1) of the transformation
        constexpr int unknowns = 15, equations = 40;
        Eigen::Matrix<double, equations, unknowns> monomials;
        Eigen::Matrix<double, equations, 1> values;
        for (int i = 0; i < equations; ++i) {
            const Transformation2D t = motion();
            const double u[] = {t.cos(), t.sin(), t.x(), t.y(), 1};
            for (int a = 0, column = 0; a < 5; ++a)
                for (int b = a; b < 5; ++b)
                    monomials(i, column++) = u[a] * u[b];
            const double value = of(fixed_, t * moving_);
            values(i) = criterion_.isSquared ? value : value * value;
        }
        const Eigen::Matrix<double, unknowns, 1> sums =
            monomials.completeOrthogonalDecomposition().solve(values);
        return (monomials * sums - values).norm() < 1e-8 * values.norm();
    }
    bool isSymmetric() { return same(of(fixed_, moving_), of(moving_, fixed_)); }

private:
    double of(const Segment &fixed, const Segment &moving) const { return criterion_.of(fixed, moving); }
    // As in figure 7.2: a unit segment from the origin, and one from it that is shifted and then turned.
    double ofUnit(double shift, double length, double angle) const {
        return of(Segment({0, 0}, {1, 0}),
                  Transformation2D(0, 0, angle) * Segment({shift, 0}, {shift + length, 0}));
    }
    static bool same(double a, double b) { return std::abs(a - b) <= 1e-9 * (std::abs(a) + std::abs(b)); }
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    Transformation2D motion() { return {between(-3, 3), between(-3, 3), between(-pi, pi)}; }
    Segment any() { return motion() * Segment({0, 0}, {between(0.5, 3), 0}); }
    double fixedAngle() const { return std::atan2(fixed_.direction().y, fixed_.direction().x); }
    Segment onLine() {
        const double from = between(-5, 5), length = between(0.5, 3);
        const Segment part = fixed_.part(from, from + length);
        return between(0, 1) < 0.5 ? part : part.reversed();
    }
    static Segment turned(const Segment &s) {
        const Point m = s.middle();
        return Transformation2D(m.x, m.y, 0) * Transformation2D(0, 0, 0.1) * Transformation2D(-m.x, -m.y, 0) *
               s;
    }

    const SegmentCriterion &criterion_;
    std::mt19937_64 &random_;
    Segment fixed_, moving_;
};

struct Property {
    const char *what;
    const char *source;
    bool (Trial::*holds)();
    std::size_t time = 1; ///< of a trial, beside the others, about
};

constexpr Property asked[] = {
    {"zero for any two segments on one line", "7.2", &Trial::isZeroOnOneLine},
    {"above zero for all others", "7.2.1", &Trial::isAboveZeroElsewhere},
    {"sliding along the static line changes nothing", "7.2, figures 7.5, 7.6", &Trial::ignoresSliding},
    {"moving both segments changes nothing", "(7.10)", &Trial::ignoresMotionOfBoth},
    {"a shift aside, a turn and a length change it", "7.2", &Trial::seesMotionAsideTurnAndLength},
    {"grows with the angle", "figure 7.3", &Trial::growsWithTheAngle},
    {"grows with the length", "figure 7.4", &Trial::growsWithTheLength},
    {"keeps its shape at small lengths", "figure 7.4, sub-plot", &Trial::keepsItsShapeAtSmallLengths},
    {"smooth, without conditions", "7.1.4, 7.2", &Trial::isSmooth, 1000},
    {"a set of pairs takes constant time, by sums", "(7.18)", &Trial::isSummed, 50},
    {"the same when the two are exchanged", "not asked for", &Trial::isSymmetric}};

} // namespace

const std::vector<SegmentCriterion> &segmentCriteria() {
    static const std::vector<SegmentCriterion> all{
        {"area", "area criterion (7.9)", "m^4", vectorlib::areaCriterion, true},
        {"quadrangle", "squared quadrangle (overview 2.2)", "m^4", squaredQuadrangle, true},
        {"hausdorff", "Hausdorff (7.2)", "m", vectorlib::hausdorffDistance, false},
        {"modified", "modified Hausdorff (7.3)", "m", vectorlib::modifiedHausdorffDistance, false},
        {"perpendicular", "modified perpendicular Hausdorff (7.6)", "m",
         vectorlib::perpendicularHausdorffDistance, false}};
    return all;
}

std::vector<CriterionProperty> criterionProperties(std::uint64_t seed, int trials,
                                                   const ProgressSink &progress) {
    std::vector<std::size_t> times;
    for (const Property &property : asked)
        times.push_back(property.time);
    ProgressParts parts(progress, times);
    std::vector<CriterionProperty> properties;
    for (const Property &property : asked) {
        properties.push_back({property.what, property.source, {}});
        const ProgressSink tell = parts.next();
        std::size_t done = 0;
        for (const SegmentCriterion &criterion : segmentCriteria()) {
            std::mt19937_64 random(seed); // the same segments for each
            int held = 0;
            for (int i = 0; i < trials; ++i) {
                held += (Trial(criterion, random).*property.holds)();
                tell(++done, segmentCriteria().size() * std::size_t(trials));
            }
            properties.back().shares.push_back(double(held) / trials);
        }
    }
    return properties;
}

Table tableOf(const std::vector<CriterionProperty> &properties) {
    Table table{"Desired properties: share of random trials in which each held", {"property", "source"}, {}};
    for (const SegmentCriterion &criterion : segmentCriteria())
        table.header.emplace_back(criterion.name);
    for (const CriterionProperty &property : properties) {
        table.rows.push_back({property.what, property.source});
        for (const double share : property.shares)
            table.rows.back().push_back(share == 1 ? "yes"
                                                   : std::to_string(std::lround(100 * share)) + "\\,\\%");
    }
    return table;
}

nlohmann::ordered_json summaryOf(const std::vector<CriterionProperty> &properties) {
    nlohmann::ordered_json json;
    for (const CriterionProperty &property : properties)
        for (std::size_t i = 0; i < property.shares.size(); ++i)
            json[property.what][segmentCriteria()[i].name] = property.shares[i];
    return json;
}

} // namespace hermes::experiments
