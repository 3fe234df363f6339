#pragma once

#include "protocol/messages/Turns.h"
#include "protocol/velodyne/TurnAssembler.h"

namespace hermes::velodynelogger {

/// Of a turn of one laser. The points come in the reverse of the order in which the sensor measured them.
ScanMessage toScanMessage(const velodyne::Turn &turn, bool replayed = false);

/// Of a turn of all lasers; coordinates are rounded to 1 mm.
CloudMessage toCloudMessage(const velodyne::Turn &turn, bool replayed = false);

} // namespace hermes::velodynelogger
