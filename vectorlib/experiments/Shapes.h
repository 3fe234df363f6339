#pragma once

#include "vectorlib/experiments/Plot.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/LineSegment2D.h"

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace hermes::experiments {

// Shapes as parts of a curve of a drawing.

inline void lineBreak(Curve &curve) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    curve.points.emplace_back(none, none);
}

inline void addPoint(Curve &curve, vectorlib::Vector2D<double> p) {
    curve.points.emplace_back(p.x, p.y);
}

inline void addSegment(Curve &curve, vectorlib::Vector2D<double> begin, vectorlib::Vector2D<double> end) {
    addPoint(curve, begin);
    addPoint(curve, end);
    lineBreak(curve);
}

/// The closed curve of middle + shape u over all unit vectors u.
inline void addEllipse(Curve &curve, vectorlib::Vector2D<double> middle, const Eigen::Matrix2d &shape) {
    constexpr int corners = 48;
    for (int i = 0; i <= corners; ++i) {
        const double angle = 2 * vectorlib::pi * i / corners;
        const Eigen::Vector2d p = shape * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        addPoint(curve, middle + vectorlib::Vector2D<double>(p.x(), p.y()));
    }
    lineBreak(curve);
}

} // namespace hermes::experiments
