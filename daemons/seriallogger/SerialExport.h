#pragma once

#include "common/Result.h"
#include "protocol/nmea/SentenceParser.h"

#include <QString>
#include <atomic>

namespace hermes::seriallogger {

/// What a CSV made of a recording has a row for: each line, all bytes that came in together (as hexadecimal
/// digits), or each fix of a GPS receiver.
enum class ExportRows { Lines, Bytes, Fixes };

/// A recorded port as CSV, made from BASE.raw and BASE.index. Blocks; for a thread that may.
struct SerialExport {
    QString base;
    QString target; ///< the file to write; appears when it is complete
    ExportRows rows = ExportRows::Lines;
    nmea::ChecksumRule checksum = nmea::ChecksumRule::Strict;

    /// The number of rows without the header. cancel: ends it early with an error.
    Result<quint64> run(const std::atomic<bool> &cancel) const;
};

} // namespace hermes::seriallogger
