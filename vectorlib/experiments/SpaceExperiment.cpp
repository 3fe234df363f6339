#include "vectorlib/experiments/SpaceExperiment.h"

#include "vectorlib/experiments/Shapes.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <sstream>
#include <tuple>

namespace hermes::experiments {

using Point = vectorlib::Vector2D<double>;
using Segment = vectorlib::LineSegment2D<double>;
using vectorlib::SegmentPair;
using vectorlib::Transformation2D;

namespace {

constexpr double degree = vectorlib::pi / 180;

vectorlib::LineSegmentRegistration registrationOf(const RegistrationExample &example) {
    vectorlib::LineSegmentRegistration registration;
    registration.stiffness = {1, 1};
    registration.add(example.pairs);
    return registration;
}

/// The matrix E of paper (22).
Eigen::Matrix2d directionsOf(const RegistrationExample &example) {
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    double weight = 0;
    for (const SegmentPair &p : example.pairs) {
        const Eigen::Vector2d v(p.fixed.direction().x, p.fixed.direction().y);
        sum += p.weight * v * v.transpose();
        weight += p.weight;
    }
    return sum / weight;
}

std::string rounded(double value, int digits) {
    std::ostringstream text;
    text.setf(std::ios::fixed);
    text.precision(digits);
    text << value;
    return text.str();
}

/// Paper (1) with erratum 6: all transformations that bring the pair into line are this one, moved along the
/// static segment.
Transformation2D idealTransformation(const SegmentPair &p) {
    const double alpha = std::atan2(p.moving.direction().cross(p.fixed.direction()),
                                    p.moving.direction().dot(p.fixed.direction()));
    const double across = p.fixed.begin().dot(p.fixed.normal()) - p.moving.begin().dot(p.moving.normal());
    const Point shift = p.fixed.normal() * across;
    return {shift.x, shift.y, alpha};
}

/// The part of each line that is within `reach` of the optimum, and the optimum.
SpacePlot spaceAround(const RegistrationExample &example, const std::string &name, const std::string &title,
                      double reach) {
    SpacePlot plot{name, title, "x [m]", "y [m]", "alpha [deg]", {}};
    const Transformation2D optimum = registrationOf(example).transformation();
    for (std::size_t i = 0; i < example.pairs.size(); ++i) {
        const Transformation2D ideal = idealTransformation(example.pairs[i]);
        const Point along = example.pairs[i].fixed.direction(), start = ideal.translation();
        const Point nearest = start + along * along.dot(optimum.translation() - start);
        SpaceCurve line{"pair " + std::to_string(i + 1), vectorlib::colour::distinct(i), {}};
        for (const double tau : {-reach, reach}) {
            const Point end = nearest + along * tau;
            line.points.push_back({end.x, end.y, ideal.alpha() / degree});
        }
        plot.curves.push_back(std::move(line));
    }
    SpaceCurve cross{"optimum", vectorlib::colour::outliers, {}};
    const double x = optimum.x(), y = optimum.y(), alpha = optimum.alpha() / degree, arm = reach / 10;
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (const auto &[dx, dy, turn] : {std::tuple{arm, 0.0, 0.0}, {0.0, arm, 0.0}, {0.0, 0.0, 0.15}})
        for (const double sign : {-1.0, 1.0, none})
            cross.points.push_back({x + sign * dx, y + sign * dy, alpha + sign * turn});
    plot.curves.push_back(std::move(cross));
    return plot;
}

} // namespace

RegistrationExample roomExample() {
    const Transformation2D away = Transformation2D(0.4, -0.3, 20 * degree).inverse();
    const auto pair = [&](Point a, Point b, double turn, double across) {
        const Segment fixed(a, b);
        const Point middle = (a + b) / 2, half = (b - a) / 2, shift = fixed.normal() * across;
        const double c = std::cos(turn * degree), s = std::sin(turn * degree);
        const Point turned(c * half.x - s * half.y, s * half.x + c * half.y);
        return SegmentPair{fixed, away * Segment(middle - turned + shift, middle + turned + shift), 1};
    };
    return {"room",
            {pair({-2, -1.5}, {2.5, -1.5}, 1.2, 0.03), pair({2.5, -1.5}, {2.5, 1}, -1.6, -0.04),
             pair({2.5, 1}, {1, 2}, 0.5, 0.02), pair({1, 2}, {-2, 2}, -0.7, 0.05),
             pair({-2, 2}, {-2, -1.5}, 2, -0.02)}};
}

RegistrationExample collinearExample() {
    constexpr double tilt = 0.01, off = 0.03; // radians, metres
    const Point up(std::cos(tilt), std::sin(tilt)), down(std::cos(tilt), -std::sin(tilt));
    const Segment first(Point(0, 0), up * 2), second(Point(2.2, 0.02), Point(2.2, 0.02) + down * 2);
    const auto across = [](const Segment &s, double by) {
        return Segment(s.begin() + s.normal() * by, s.end() + s.normal() * by);
    };
    return {"collinear", {{first, across(first, off), 1}, {second, across(second, -off), 1}}};
}

RegistrationExample directionsExample() {
    RegistrationExample example{"directions", {}};
    for (const double angle : {12, 20, 28, 35, 200, 218, 100}) {
        const Point v(std::cos(angle * degree), std::sin(angle * degree));
        const Point begin = Point(v.y, -v.x) * 2;
        example.pairs.push_back({Segment(begin, begin + v), Segment(begin, begin + v), 1});
    }
    return example;
}

void writeCsv(std::ostream &out, const std::vector<RegistrationExample> &examples) {
    using vectorlib::Number;
    out << "example,pair,kind,x1,y1,x2,y2\n";
    for (const RegistrationExample &example : examples) {
        const Transformation2D optimum = registrationOf(example).transformation();
        for (std::size_t i = 0; i < example.pairs.size(); ++i) {
            const SegmentPair &p = example.pairs[i];
            for (const auto &[kind, s] : {std::pair<const char *, Segment>{"static", p.fixed},
                                          {"dynamic", p.moving},
                                          {"registered", optimum * p.moving}})
                out << example.name << ',' << i + 1 << ',' << kind << ',' << Number(s.begin().x) << ','
                    << Number(s.begin().y) << ',' << Number(s.end().x) << ',' << Number(s.end().y) << '\n';
        }
    }
}

nlohmann::ordered_json summaryOf(const std::vector<RegistrationExample> &examples) {
    nlohmann::ordered_json summary;
    for (const RegistrationExample &example : examples) {
        const vectorlib::LineSegmentRegistration registration = registrationOf(example);
        const Transformation2D t = registration.transformation();
        const vectorlib::Ambiguity ambiguity = registration.ambiguity();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(directionsOf(example));
        const double least = std::max(0.0, eigen.eigenvalues()(0)), most = eigen.eigenvalues()(1);
        summary[example.name] = {{"x_m", t.x()},
                                 {"y_m", t.y()},
                                 {"alpha_deg", t.alpha() / degree},
                                 {"a_t_m2", ambiguity.xy},
                                 {"a_alpha_rad2", ambiguity.alpha},
                                 {"reliability", registration.reliability()},
                                 {"lambda", {most, least}},
                                 {"epsilon_deg", std::atan2(std::sqrt(least), std::sqrt(most)) / degree}};
    }
    return summary;
}

std::vector<SpacePlot> transformationSpace(const RegistrationExample &example) {
    return {spaceAround(example, "transformations", "all ideal transformations of five pairs", 1.5),
            spaceAround(example, "transformations-near", "the same near the optimum", 0.12)};
}

Plot collinearPlot(const RegistrationExample &example) {
    const Transformation2D optimum = registrationOf(example).transformation();
    Curve fixed{"static", vectorlib::colour::map, {}},
        before{"dynamic, measured", vectorlib::colour::before, {}},
        after{"dynamic, registered", vectorlib::colour::estimate, {}};
    for (const SegmentPair &p : example.pairs) {
        const Segment moved = optimum * p.moving;
        addSegment(fixed, p.fixed.begin(), p.fixed.end());
        addSegment(before, p.moving.begin(), p.moving.end());
        addSegment(after, moved.begin(), moved.end());
    }
    return {"collinear",
            "nearly collinear segments: R = " + rounded(registrationOf(example).reliability(), 2) +
                ", moved by " + rounded(optimum.x(), 1) + " m",
            "x [m]",
            "y [m], to another scale",
            false,
            false,
            {fixed, before, after}};
}

Plot reliabilityEllipse(const RegistrationExample &example) {
    constexpr double dot = 0.02; // radius of a mark
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(directionsOf(example));
    const Eigen::Vector2d roots = eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
    const auto axis = [&](int i) {
        const Eigen::Vector2d v = eigen.eigenvectors().col(i) * roots(i);
        return Point(v.x(), v.y());
    };
    const Point minor = axis(0), major = axis(1);
    Curve circle{"unit circle", vectorlib::colour::points, {}},
        ends{"directions and their opposites", vectorlib::colour::map, {}},
        ellipse{"half axes: roots of the eigenvalues", vectorlib::colour::estimate, {}},
        angle{"epsilon", vectorlib::colour::reference, {}};
    const Eigen::Matrix2d unit = Eigen::Matrix2d::Identity();
    addEllipse(circle, {}, unit);
    for (const SegmentPair &p : example.pairs)
        for (const double sign : {1.0, -1.0})
            addEllipse(ends, p.fixed.direction() * sign, unit * dot);
    addEllipse(ellipse, {}, eigen.eigenvectors() * Eigen::Matrix2d(roots.asDiagonal()));
    addSegment(ellipse, {}, major);
    addSegment(ellipse, {}, minor);
    // The eigenvalues sum to 1 (erratum 9), so that this corner of their box lies on the circle.
    addSegment(angle, {}, major + minor);
    const double epsilon = std::atan2(roots(0), roots(1));
    const double from = std::atan2(major.y, major.x), turn = major.cross(minor) > 0 ? epsilon : -epsilon;
    for (int i = 0; i <= 16; ++i) {
        const double at = from + turn * i / 16;
        addPoint(angle, Point(std::cos(at), std::sin(at)) * 0.35);
    }
    return {"ellipse",
            "R = sin(2 epsilon) = " + rounded(std::sin(2 * epsilon), 2) +
                ", epsilon = " + rounded(epsilon / degree, 1) + " degrees",
            "x",
            "y",
            false,
            false,
            {circle, ends, ellipse, angle},
            true};
}

} // namespace hermes::experiments
