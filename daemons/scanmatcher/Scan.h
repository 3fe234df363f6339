#pragma once

#include "common/Result.h"
#include "daemons/scanmatcher/OdometryTrack.h"
#include "vectorlib/geometry/Vector2D.h"

#include <QJsonObject>
#include <optional>
#include <vector>

namespace hermes {

/// A scan as the matcher takes it: points in the sensor's frame, counter-clockwise.
struct Scan {
    double stamp = 0; ///< seconds since the Unix epoch; the reference time of `seconds`
    quint64 number = 0;
    bool partial = false;                           ///< not a whole turn: the first or last of a stream
    std::vector<vectorlib::Vector2D<float>> points; ///< metres
    std::vector<float> seconds;            ///< of each point, after stamp; empty when measured at once
    std::optional<OdometryTrack> odometry; ///< of the robot during the scan, when it is known

    /// Of the first and of the last point.
    double begin() const;
    double end() const;
};

/// Reads the data of a `scan2d` message: {stamp, turn?, partial?, x: [], y: [], t?: []}; other members are
/// left alone. The error says which member is wrong, what was found and what was expected.
Result<Scan> parseScan(const QJsonObject &data);

} // namespace hermes
