#pragma once

#include "common/Result.h"
#include "protocol/wire/WireValue.h"
#include "vectorlib/mapping/TimedScan.h"

namespace hermes::scanmatcher {

/// A scan as a logger publishes it.
struct Scan {
    quint64 number = 0;
    bool partial = false; ///< not a whole turn: the first or last of a stream
    bool replayed = false;
    vectorlib::TimedScan data;
};

/// Reads a `scan2d` message; only stamp, x and y must be there. Without `rays` the scanner is taken to have
/// had a return of each. The error says which member is wrong, what was found and what was expected. unknown
/// counts members that this program does not know.
Result<Scan> readScan(WireView data, quint64 &unknown);

/// Reads an `odometry` message: pose, twist and covariance must be there.
Result<vectorlib::OdometrySample> readOdometry(WireView data, double stamp, quint64 &unknown);

} // namespace hermes::scanmatcher
