#include "daemons/velodynelogger/ScanMessage.h"

#include <QJsonArray>

#include <cmath>

namespace hermes {

namespace {

/// Short numbers make short messages; the sensor counts 2 mm.
double rounded(double value, double perUnit) {
    return std::round(value * perUnit) / perUnit;
}

} // namespace

QJsonObject toScanMessage(const velodyne::Turn &turn) {
    QJsonArray x, y, t, intensity;
    for (auto point = turn.points.rbegin(); point != turn.points.rend(); ++point) {
        x.append(rounded(point->x, 1e5));
        y.append(rounded(point->y, 1e5));
        t.append(rounded(double(point->stamp_ns - turn.begin_ns) * 1e-9, 1e6));
        intensity.append(point->intensity);
    }
    return {{"turn", double(turn.number)},
            {"stamp", double(turn.begin_ns) * 1e-9},
            {"duration_s", double(turn.end_ns - turn.begin_ns) * 1e-9},
            {"partial", turn.partial},
            {"lost_packets", double(turn.lostPackets)},
            {"frame", "lidar"},
            {"laser", turn.laser},
            {"x", x},
            {"y", y},
            {"t", t},
            {"intensity", intensity}};
}

} // namespace hermes
