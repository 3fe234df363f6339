#pragma once

#include "protocol/velodyne/TurnAssembler.h"

#include <QJsonObject>

namespace hermes {

/// The data of a `scan2d` message: the points of one laser in one turn, COUNTER-CLOCKWISE, the reverse of the
/// order in which the sensor measured them, as the vector library wants them. Lengths and times are floats:
/// who reads floats gets what `hermes-vector map` gets of the same packets.
QJsonObject toScanMessage(const velodyne::Turn &turn);

/// The data of a `cloud` message: the points of all lasers in one turn, in the order of measuring, as arrays
/// x, y, z (metres, rounded to 1 mm), laser and intensity.
QJsonObject toCloudMessage(const velodyne::Turn &turn);

} // namespace hermes
