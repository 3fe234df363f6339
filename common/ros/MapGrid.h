#pragma once

#include "protocol/messages/VectorMap.h"
#include "protocol/ros/Marker.h"
#include "protocol/ros/Messages.h"
#include "vectorlib/geometry/Pose2D.h"

#include <map>
#include <vector>

namespace hermes::ros {

/// The vector map as cells. A cell that an edge touches is occupied. A cell is free when it was seen through:
/// it lies between a place where the sensor was and the first wall in some direction. All others are unknown.
class MapGrid {
public:
    /// cell: its side, m. Maps that would have more than maxCells get larger ones.
    explicit MapGrid(double cell)
        : cell_(cell) {}

    void clear(); ///< the edges; places stay
    void set(const MapEdgeMessage &edge);
    void remove(qint64 id);
    bool isEmpty() const { return edges_.empty(); }

    /// Where the sensor was, one place for each key scan.
    void clearPlaces() { places_.clear(); }
    void addPlace(double x, double y) { places_.push_back({x, y}); }

    /// All cells; header and time are the caller's.
    void draw(OccupancyGrid &grid) const;
    /// The edges as lines.
    void draw(Marker &marker) const;

    static constexpr double reach = 30; ///< m: nothing is seen through beyond

private:
    struct Place {
        double x, y;
    };
    struct Drawing;

    const double cell_;
    std::map<qint64, MapEdgeMessage> edges_;
    std::vector<Place> places_;
};

} // namespace hermes::ros
