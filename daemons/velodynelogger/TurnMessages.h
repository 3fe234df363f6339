#pragma once

#include "daemons/velodynelogger/TurnQueue.h"
#include "protocol/messages/Turns.h"

namespace hermes::velodynelogger {

/// Of a turn of one laser. The points come in the reverse of the order in which the sensor measured them.
ScanMessage toScanMessage(const FinishedTurn &turn);

/// Of a turn of all lasers; coordinates are rounded to 1 mm.
CloudMessage toCloudMessage(const FinishedTurn &turn);

} // namespace hermes::velodynelogger
