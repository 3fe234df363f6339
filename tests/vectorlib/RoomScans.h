#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/observation/Observer.h"

using Segment = vectorlib::LineSegment2D<double>;
using Segments = std::vector<Segment>;
using Point = vectorlib::Vector2D<double>;

/// What a sensor sees of a world, without noise; in the frame of the sensor.
inline Segments seenFrom(const Segments &world, const vectorlib::Pose2D &pose) {
    vectorlib::Observer<double> observe;
    Segments view;
    for (const auto &part : observe(world, pose))
        view.push_back(part.segment);
    return view;
}
/// A room of 6 m x 4 m about the origin with a notch, so that it looks different from everywhere.
inline Segments room() {
    const std::vector<Point> corners = {{-3, -2}, {3, -2}, {3, 1}, {2, 1}, {2, 2}, {-3, 2}};
    Segments edges;
    for (std::size_t i = 0; i < corners.size(); ++i)
        edges.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    return edges;
}
inline Segments moved(const vectorlib::Transformation2D &t, const Segments &segments) {
    Segments result;
    for (const Segment &s : segments)
        result.push_back(t * s);
    return result;
}
