#include "daemons/velodynelogger/CloudMessage.h"

#include <QJsonArray>

#include <cmath>

namespace hermes {

QJsonObject toCloudMessage(const velodyne::Turn &turn) {
    const auto array = [&turn](auto value) {
        QJsonArray values;
        for (const velodyne::Point &point : turn.points)
            values.append(value(point));
        return values;
    };
    const auto metres = [](double value) { return std::round(value * 1000) / 1000; };
    return {{"turn", double(turn.number)},
            {"stamp", double(turn.begin_ns) * 1e-9},
            {"duration_s", double(turn.end_ns - turn.begin_ns) * 1e-9},
            {"partial", turn.partial},
            {"lost_packets", double(turn.lostPackets)},
            {"frame", "lidar"},
            {"model", turn.model->name},
            {"x", array([&](const velodyne::Point &point) { return metres(point.x); })},
            {"y", array([&](const velodyne::Point &point) { return metres(point.y); })},
            {"z", array([&](const velodyne::Point &point) { return metres(point.z); })},
            {"laser", array([](const velodyne::Point &point) { return int(point.laser); })},
            {"intensity", array([](const velodyne::Point &point) { return int(point.intensity); })}};
}

} // namespace hermes
