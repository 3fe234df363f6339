#pragma once

#include "protocol/velodyne/TurnAssembler.h"

#include <QJsonObject>

namespace hermes {

/// The data of a `cloud` message: the points of all lasers in one turn, in the order of measuring, as arrays
/// x, y, z (metres, rounded to 1 mm), laser and intensity.
QJsonObject toCloudMessage(const velodyne::Turn &turn);

} // namespace hermes
