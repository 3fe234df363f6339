#include "common/ros/MapMessages.h"

#include "common/Time.h"
#include "common/ros/Motion.h"

#include <cmath>

namespace hermes::ros {
namespace {

constexpr double drawnShare = 0.1; // of one core
constexpr double maxPause_s = 30;
constexpr std::size_t maxVisited = 20000;

} // namespace

bool MapFollower::take(const TopicUpdate &update, const Told &told, std::string &, QString &problem) {
    ReadReport report;
    if (update.topic == "map") {
        if (const auto map = readMessage<MapMessage>(update.data, report))
            takeMap(*map);
    } else if (update.topic == "graph") {
        if (const auto graph = readMessage<GraphMessage>(update.data, report))
            takeGraph(*graph);
    } else if (const auto pose = readMessage<PoseMessage>(update.data, report)) {
        takePose(*pose);
    }
    if (report.hasFailed())
        problem = report.text();
    else
        stamp_ = told.stamp;
    return false; // refresh() draws
}

void MapFollower::takeMap(const MapMessage &map) {
    if (map.cleared)
        grid_.clear();
    for (const qint64 id : map.removed)
        grid_.remove(id);
    for (const MapEdgeMessage &edge : map.edges)
        grid_.set(edge);
    hasChanged_ = hasChanged_ || map.cleared || !map.removed.empty() || !map.edges.empty();
}

void MapFollower::takeGraph(const GraphMessage &graph) {
    if (graph.cleared || !hasGraph_) {
        grid_.clearPlaces();
        visited_.clear();
    }
    hasGraph_ = graph.size > 0;
    for (const auto &[x, y, theta] : graph.poses)
        grid_.addPlace(x, y);
    hasChanged_ = hasChanged_ || graph.cleared || !graph.poses.empty();
}

/// In a map that was loaded there is no graph: the robot sees again what is free.
void MapFollower::takePose(const PoseMessage &pose) {
    if (hasGraph_ || pose.outcome != "matched" || pose.trust < leastTrust || visited_.size() >= maxVisited)
        return;
    const std::pair<int, int> where(int(std::lround(2 * pose.pose.x)), int(std::lround(2 * pose.pose.y)));
    if (!visited_.insert(where).second)
        return;
    grid_.addPlace(pose.pose.x, pose.pose.y);
    hasChanged_ = true;
}

bool GridOfMap::refresh(const RobotModel &robot, double now, std::string &cdr) {
    const bool mustWait = now < next_ && now > next_ - maxPause_s; // a clock may be set
    const bool isNone = grid_.isEmpty() && out_.data.empty(); // without cells it is no map for navigation
    if (mustWait || isNone || !isNew())
        return false;
    const double begin = monotonicNow();
    OccupancyGrid drawn;
    grid_.draw(drawn);
    if (drawn.data.empty()) { // the map was forgotten: so are the cells
        drawn.info = out_.info;
        drawn.data.assign(out_.data.size(), -1);
    }
    next_ = now + std::min(maxPause_s, (monotonicNow() - begin) / drawnShare);
    if (drawn.data == out_.data && drawn.info.width == out_.info.width)
        return false; // edges move by less than a cell all the time
    out_ = std::move(drawn);
    out_.header = headerOf(stamp_, robot.mapFrame());
    out_.info.mapLoadTime = out_.header.stamp;
    toCdr(out_, cdr);
    return true;
}

bool WallsOfMap::refresh(const RobotModel &robot, double, std::string &cdr) {
    if (!isNew())
        return false;
    MarkerArray array;
    array.markers.resize(1);
    grid_.draw(array.markers[0]);
    array.markers[0].header = headerOf(stamp_, robot.mapFrame());
    toCdr(array, cdr);
    return true;
}

} // namespace hermes::ros
