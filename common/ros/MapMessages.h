#pragma once

#include "common/ros/MapGrid.h"
#include "common/ros/Mapping.h"
#include "protocol/messages/Matching.h"

#include <set>

namespace hermes::ros {

/// The map, kept from its changes; of which something is drawn at most once a second, and only when it
/// changed.
class MapFollower : public Translator {
public:
    bool take(const TopicUpdate &update, const Told &told, std::string &cdr, QString &problem) override;

protected:
    /// Whether the map is another one than when this was asked last.
    bool isNew() { return std::exchange(hasChanged_, false); }

    MapGrid grid_{cell};
    double stamp_ = 0; ///< of the last change

    static constexpr double cell = 0.05; // m

private:
    void takeMap(const MapMessage &map);
    void takeGraph(const GraphMessage &graph);
    void takePose(const PoseMessage &pose);

    bool hasChanged_ = false;
    bool hasGraph_ = false;
    std::set<std::pair<int, int>> visited_; ///< where poses were, where no graph tells it; in half metres
};

/// The map as cells. Drawing it takes a tenth of the time at most.
class GridOfMap : public MapFollower {
public:
    bool refresh(const RobotModel &robot, double now, std::string &cdr) override;

private:
    OccupancyGrid out_;
    double next_ = 0; ///< not before, in seconds since the epoch
};

/// The map as lines.
class WallsOfMap : public MapFollower {
public:
    bool refresh(const RobotModel &robot, double now, std::string &cdr) override;
};

} // namespace hermes::ros
