#pragma once

#include "common/world/World.h"
#include "vectorlib/geometry/LineSegment2D.h"

/// The room with eight pillars that the demo drives through.
inline hermes::World pillars() {
    const auto world = hermes::readWorld(qEnvironmentVariable("HERMES_SOURCE").toStdString() +
                                         "/deploy/worlds/pillars.json");
    if (!world)
        qFatal("%s", world.error().c_str());
    return *world;
}

/// From a point to the nearest wall; metres.
inline double distanceToWalls(const hermes::World &world, vectorlib::Vector2D<double> p) {
    double nearest = 1e9;
    for (const hermes::World::Edge &e : world.edges)
        nearest = std::min(nearest, vectorlib::LineSegment2D<double>({e.x1, e.y1}, {e.x2, e.y2}).distance(p));
    return nearest;
}
