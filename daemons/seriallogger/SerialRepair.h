#pragma once

#include "common/recording/RecordingWriter.h"

namespace hermes::seriallogger {

/// Cuts each index of a recording that was cut off back to whole records with bytes, the events back to whole
/// lines, and brings files, counts, bytes and end of the sidecar up to what is there. Not a byte of a port is
/// touched.
Result<void> repairSerialRecording(const RecordingPlan &plan, QJsonObject &sidecar);

} // namespace hermes::seriallogger
