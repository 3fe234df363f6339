#pragma once

#include "protocol/wire/FieldsOf.h"

#include <QJsonValue>
#include <QMap>
#include <QStringList>
#include <optional>
#include <vector>

namespace hermes {

/// By what it is that is counted.
using NamedCounts = QMap<QString, double>;

/// Why a recording ended.
struct RecordingError {
    int code = 0;
    QString message;
    std::optional<QJsonValue> data;
};

/// What record.status gives, and record.start and record.stop: of the recording under way or the last.
struct RecordingStatus {
    bool recording = false;
    std::optional<double> freeBytes;
    std::optional<RecordingError> error;
    std::optional<QString> name, session, folder, path;
    std::optional<double> start, duration_s, bytes; ///< duration: so far, by a clock that never jumps
    std::optional<qint64> files;
    std::optional<NamedCounts> counts, losses;
};

/// Of what record.list gives a list: what the sidecar of a recording tells, or why it cannot be read.
struct RecordingEntry {
    QString name;
    std::optional<QString> folder, session;
    std::optional<QStringList> loggers;
    std::optional<double> start, start_mono;
    std::optional<QString> boot;
    std::optional<std::optional<double>> end; ///< nothing: not yet
    std::optional<double> duration_s;         ///< by a clock that never jumps; only where it has ended
    std::optional<std::optional<QString>> ended;
    std::optional<bool> complete;
    std::optional<qint64> files;
    std::optional<double> bytes;
    std::optional<NamedCounts> counts, losses;
    std::optional<QString> error;
};

/// Where what a logger shows comes from; what source.open, source.pause and source.seek give.
struct SourceStatus {
    QString state;
    std::optional<QString> name;
    std::optional<double> speed, position_s;
    std::optional<bool> loop, paused;
    std::optional<quint64> loops;
    std::optional<std::optional<double>> duration_s; ///< nothing: not known as yet
    std::optional<QString> error;
};

Fields<RecordingError> fieldsOf(Of<RecordingError>);
Fields<RecordingStatus> fieldsOf(Of<RecordingStatus>);
Fields<RecordingEntry> fieldsOf(Of<RecordingEntry>);
Fields<SourceStatus> fieldsOf(Of<SourceStatus>);

} // namespace hermes
