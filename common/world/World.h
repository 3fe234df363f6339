#pragma once

#include "vectorlib/geometry/Pose2D.h"

#include <string>
#include <vector>

namespace hermes {

/// A made-up environment: walls in the plane and the poses along which a robot passes through it.
struct World {
    /// A wall from (x1, y1) to (x2, y2), metres. Free space lies on its left.
    struct Edge {
        double x1, y1, x2, y2;
    };

    std::string name;
    std::vector<Edge> edges;
    std::vector<vectorlib::Pose2D> poses;
};

bool operator==(const World::Edge &a, const World::Edge &b);
bool operator==(const World &a, const World &b);

/// What is wrong with an edge or a pose, or an empty string: numbers that are not finite, an edge of no
/// length.
std::string faultOf(const World::Edge &edge);
std::string faultOf(const vectorlib::Pose2D &pose);

} // namespace hermes
