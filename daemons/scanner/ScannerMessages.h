#pragma once

#include "protocol/messages/Recordings.h"

namespace hermes::scanner {

/// The topic `scanner`, and what source.status gives.
struct ScannerMessage {
    SourceStatus source;
    std::optional<QString> model, device, firmware, serial; ///< nothing: not known
    QString url, line;                                      ///< where it is; open, opening or closed
    double rpm = 0;
    quint64 beams = 0, revolutions = 0, partial = 0, missed = 0, packets = 0, damaged = 0, lost = 0,
            skippedBytes = 0;
    quint64 bytes = 0, unreadBytes = 0;
    RecordingStatus recording;
};

Fields<ScannerMessage> fieldsOf(Of<ScannerMessage>);

} // namespace hermes::scanner
