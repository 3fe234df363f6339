#pragma once

#include <string>
#include <vector>

namespace hermes {

/// A made-up environment: walls in the plane and the poses along which a robot passes through it.
struct World {
    /// A wall from (x1, y1) to (x2, y2), metres. Free space lies on its left.
    struct Edge {
        double x1, y1, x2, y2;
    };
    /// Metres; heading in radians, counter-clockwise from the x axis.
    struct Pose {
        double x, y, theta;
    };

    std::string name;
    std::vector<Edge> edges;
    std::vector<Pose> poses;
};

bool operator==(const World::Edge &a, const World::Edge &b);
bool operator==(const World::Pose &a, const World::Pose &b);
bool operator==(const World &a, const World &b);

/// What is wrong with an edge or a pose, or an empty string: numbers that are not finite, an edge of no
/// length.
std::string faultOf(const World::Edge &edge);
std::string faultOf(const World::Pose &pose);

} // namespace hermes
