#pragma once

#include "common/recording/StoredRecording.h"
#include "daemons/seriallogger/SerialMessages.h"

namespace hermes::seriallogger {

/// The marks among the events of a recording that has ended, in the order of the file, at most 1000. Lines
/// that are no marks, or make no sense, are passed over. InputOutput: the events cannot be read. Blocks.
Result<std::vector<RecordedMark>> readMarks(const StoredRecording &recording);

} // namespace hermes::seriallogger
