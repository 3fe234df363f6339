#include "daemons/velodynelogger/TurnMessages.h"

#include <cmath>

namespace hermes::velodynelogger {

namespace {

/// Short numbers make short messages; the sensor counts 2 mm.
float rounded(double metres) {
    return float(std::round(metres * 1e3) / 1e3);
}

QString toText(velodyne::StampSource clock) {
    return clock == velodyne::StampSource::Host  ? "host"
           : clock == velodyne::StampSource::Gps ? "gps"
                                                 : "sensor";
}

TurnHeader headerOf(const FinishedTurn &turn) {
    return {turn.number,
            double(turn.begin_ns) * 1e-9,
            double(turn.end_ns - turn.begin_ns) * 1e-9,
            turn.partial,
            turn.firings,
            turn.lostPackets,
            "lidar",
            turn.replayed,
            toText(turn.clock),
            turn.clock == velodyne::StampSource::Host ? std::optional(double(turn.clockBound_ns) * 1e-9)
                                                      : std::nullopt};
}

} // namespace

ScanMessage toScanMessage(const FinishedTurn &turn) {
    ScanMessage message;
    message.header = headerOf(turn);
    message.laser = turn.laser;
    std::vector<float> &t = message.t.emplace();
    for (std::vector<float> *values : {&message.x, &message.y, &t})
        values->reserve(turn.points.size());
    message.intensity.reserve(turn.points.size());
    for (auto point = turn.points.rbegin(); point != turn.points.rend(); ++point) {
        message.x.push_back(float(point->x));
        message.y.push_back(float(point->y));
        t.push_back(float(double(point->stamp_ns - turn.begin_ns) * 1e-9));
        message.intensity.push_back(point->intensity);
    }
    return message;
}

CloudMessage toCloudMessage(const FinishedTurn &turn) {
    CloudMessage message;
    message.header = headerOf(turn);
    message.model = turn.model->name;
    for (std::vector<float> *values : {&message.x, &message.y, &message.z})
        values->reserve(turn.points.size());
    for (const velodyne::Point &point : turn.points) {
        message.x.push_back(rounded(point.x));
        message.y.push_back(rounded(point.y));
        message.z.push_back(rounded(point.z));
        message.laser.push_back(point.laser);
        message.intensity.push_back(point.intensity);
    }
    return message;
}

} // namespace hermes::velodynelogger
