#pragma once

#include "common/Outcome.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <string>
#include <vector>

namespace hermes {

/// A made-up environment: walls in the plane and the poses along which a robot passes through it.
struct World {
    /// A wall from (x1, y1) to (x2, y2), metres. Free space lies on its left.
    struct Edge {
        double x1, y1, x2, y2;
    };

    /// Someone who walks along a polyline and back, again and again.
    struct Person {
        double speed;                                 ///< m/s
        std::vector<vectorlib::Vector2D<double>> way; ///< two or more points; metres
    };

    std::string name;
    std::vector<Edge> edges;
    std::vector<vectorlib::Pose2D> poses;
    std::vector<Person> people;
};

/// Reads a world from JSON: {"name", "edges": [[x1,y1,x2,y2], ...], "poses": [[x,y,theta], ...], "people":
/// [[speed,x1,y1,x2,y2, ...], ...]}; all but edges may be absent, anything else is refused.
Outcome<World> readWorld(const std::string &path);

/// The same from text; path only names it in messages.
Outcome<World> parseWorld(const std::string &text, const std::string &path);

} // namespace hermes
