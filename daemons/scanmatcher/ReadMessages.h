#pragma once

#include "common/Result.h"
#include "vectorlib/mapping/TimedScan.h"

#include <QJsonObject>

namespace hermes {

/// A scan as a logger publishes it.
struct Scan {
    quint64 number = 0;
    bool partial = false; ///< not a whole turn: the first or last of a stream
    vectorlib::TimedScan data;
};

/// Reads the data of a `scan2d` message: {stamp, turn?, partial?, rays?, x: [], y: [], t?: []}; other members
/// are left alone. Without `rays` the scanner is taken to have had a return of each. The error says which
/// member is wrong, what was found and what was expected.
Result<Scan> readScan(const QJsonObject &data);

/// Reads the data of an `odometry` message: {pose: {x, y, theta}, twist: {vx, vy, omega}, covariance: 9
/// numbers}; the same holds.
Result<vectorlib::OdometrySample> readOdometry(const QJsonObject &data, double stamp);

} // namespace hermes
