#include "daemons/velodynelogger/TurnMessages.h"

#include <QJsonArray>

#include <charconv>
#include <cmath>

namespace hermes {

namespace {

/// Short numbers make short messages; the sensor counts 2 mm.
double rounded(double value, double perUnit) {
    return std::round(value * perUnit) / perUnit;
}

/// The shortest decimal fraction that a reader of floats takes for the same: short messages, and nothing
/// lost.
double shortest(float value) {
    char text[32];
    const auto written = std::to_chars(text, text + sizeof text, value);
    double result = 0;
    std::from_chars(text, written.ptr, result);
    return result;
}

/// What is told of every turn.
QJsonObject describe(const velodyne::Turn &turn) {
    return {{"turn", double(turn.number)},
            {"stamp", double(turn.begin_ns) * 1e-9},
            {"duration_s", double(turn.end_ns - turn.begin_ns) * 1e-9},
            {"partial", turn.partial},
            {"rays", double(turn.firings)},
            {"lost_packets", double(turn.lostPackets)},
            {"frame", "lidar"}};
}

} // namespace

QJsonObject toScanMessage(const velodyne::Turn &turn) {
    QJsonArray x, y, t, intensity;
    for (auto point = turn.points.rbegin(); point != turn.points.rend(); ++point) {
        x.append(shortest(float(point->x)));
        y.append(shortest(float(point->y)));
        t.append(shortest(float(double(point->stamp_ns - turn.begin_ns) * 1e-9)));
        intensity.append(point->intensity);
    }
    QJsonObject message = describe(turn);
    message["laser"] = turn.laser;
    message["x"] = x;
    message["y"] = y;
    message["t"] = t;
    message["intensity"] = intensity;
    return message;
}

QJsonObject toCloudMessage(const velodyne::Turn &turn) {
    QJsonArray x, y, z, laser, intensity;
    for (const velodyne::Point &point : turn.points) {
        x.append(rounded(point.x, 1e3));
        y.append(rounded(point.y, 1e3));
        z.append(rounded(point.z, 1e3));
        laser.append(int(point.laser));
        intensity.append(int(point.intensity));
    }
    QJsonObject message = describe(turn);
    message["model"] = turn.model->name;
    message["x"] = x;
    message["y"] = y;
    message["z"] = z;
    message["laser"] = laser;
    message["intensity"] = intensity;
    return message;
}

} // namespace hermes
