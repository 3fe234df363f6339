#include "common/world/World.h"

#include <cmath>

namespace hermes {

namespace {

constexpr double shortestEdge = 1e-6; // metres

} // namespace

bool operator==(const World::Edge &a, const World::Edge &b) {
    return a.x1 == b.x1 && a.y1 == b.y1 && a.x2 == b.x2 && a.y2 == b.y2;
}

bool operator==(const World &a, const World &b) {
    return a.name == b.name && a.edges == b.edges && a.poses == b.poses;
}

std::string faultOf(const World::Edge &edge) {
    for (const double value : {edge.x1, edge.y1, edge.x2, edge.y2}) {
        if (!std::isfinite(value))
            return "an edge's coordinates must be finite";
    }
    if (std::hypot(edge.x2 - edge.x1, edge.y2 - edge.y1) < shortestEdge)
        return "an edge must not begin where it ends";
    return {};
}

std::string faultOf(const vectorlib::Pose2D &pose) {
    const bool finite = std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta);
    return finite ? std::string() : "a pose's numbers must be finite";
}

} // namespace hermes
