#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <cmath>

namespace hermes::experiments {

/// The line r = d / (u . n) with the least sum of squared errors of the ranges r: maximum likelihood of noise
/// along the rays from the origin, which has no bias by noise along the line. Gauss-Newton from a given
/// segment; that one where it does not get better. The ends are those of the given one, moved across.
inline vectorlib::LineSegment2D<double> fitRanges(vectorlib::PointSpan<double> points,
                                                  const vectorlib::LineSegment2D<double> &start) {
    const auto normal = [](double angle) {
        return vectorlib::Vector2D<double>(std::cos(angle), std::sin(angle));
    };
    const auto costOf = [&](double angle, double d) {
        double sum = 0;
        for (const vectorlib::Vector2D<double> &p : points) {
            const double error = p.norm() - d * p.norm() / p.dot(normal(angle));
            sum += error * error;
        }
        return sum;
    };
    double angle = std::atan2(start.normal().y, start.normal().x), d = start.begin().dot(start.normal());
    const double before = costOf(angle, d);
    const double angleBefore = angle, distanceBefore = d;
    for (int step = 0; step < 8; ++step) {
        const vectorlib::Vector2D<double> n = normal(angle), across(-n.y, n.x);
        double aa = 0, ab = 0, bb = 0, ea = 0, eb = 0;
        for (const vectorlib::Vector2D<double> &p : points) {
            const double r = p.norm(), c = p.dot(n) / r, s = p.dot(across) / r;
            const double byDistance = 1 / c, byAngle = -d * s / (c * c), error = r - d / c;
            aa += byDistance * byDistance;
            ab += byDistance * byAngle;
            bb += byAngle * byAngle;
            ea += byDistance * error;
            eb += byAngle * error;
        }
        const double determinant = aa * bb - ab * ab;
        if (!(determinant > 0))
            break;
        d += (bb * ea - ab * eb) / determinant;
        angle += (aa * eb - ab * ea) / determinant;
    }
    if (!(costOf(angle, d) < before)) {
        angle = angleBefore;
        d = distanceBefore;
    }
    const vectorlib::Vector2D<double> n = normal(angle);
    const auto onto = [&](vectorlib::Vector2D<double> p) { return p - n * (p.dot(n) - d); };
    return {onto(start.begin()), onto(start.end())};
}

} // namespace hermes::experiments
