#pragma once

#include <vectorlib/geometry/LineSegment2D.h>
#include <vectorlib/geometry/Transformation2D.h>

/// Pairs within 8 m of the static origin that `truth` brings onto each other exactly; the dynamic ones are
/// slid along their lines and cut differently. Any direction, weights between 0.5 and 3.
inline std::vector<vectorlib::SegmentPair> randomPairs(const vectorlib::Transformation2D &truth, int count,
                                                       std::mt19937 &random) {
    using namespace vectorlib;
    std::uniform_real_distribution<double> position(-5, 5), angle(-pi, pi), length(0.5, 3);
    std::vector<SegmentPair> pairs;
    for (int i = 0; i < count; ++i) {
        const Vector2D<double> begin(position(random), position(random));
        const double a = angle(random);
        const Vector2D<double> d(std::cos(a), std::sin(a));
        const LineSegment2D<double> fixed(begin, begin + d * length(random));
        const LineSegment2D<double> seen(begin + d * length(random), begin + d * (3 + length(random)));
        pairs.push_back({fixed, truth.inverse() * seen, length(random)});
    }
    return pairs;
}

/// How far two transformations are apart: metres plus radians.
inline double difference(const vectorlib::Transformation2D &a, const vectorlib::Transformation2D &b) {
    const vectorlib::Transformation2D d = a.inverse() * b;
    return d.translation().norm() + std::abs(d.alpha());
}
