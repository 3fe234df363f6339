#pragma once

#include "common/recording/RecordingWriter.h"

namespace hermes::velodynelogger {

/// Cuts the capture files of a recording that was cut off back to whole datagrams, and brings `files`,
/// `bytes`, `counts`, `losses` and `end` of its sidecar up to what they hold. Reads only what the sidecar
/// does not know.
Result<void> repairPcapFiles(const RecordingPlan &plan, QJsonObject &sidecar);

} // namespace hermes::velodynelogger
