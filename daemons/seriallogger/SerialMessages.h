#pragma once

#include "daemons/seriallogger/FixEpoch.h"
#include "protocol/messages/Fixes.h"
#include "protocol/messages/Recordings.h"

namespace hermes::seriallogger {

/// The topic `lines`: a line of a port.
struct LineMessage {
    QString port;
    double stamp = 0, mono = 0;
    QString text;
    bool cut = false;
};

/// What was found in the bytes of a port with view nmea.
struct NmeaCounts {
    quint64 sentences = 0, badChecksum = 0, noChecksum = 0, tooLong = 0, badByte = 0, cutShort = 0;
    quint64 skippedBytes = 0, badFields = 0, repeated = 0, late = 0;
    std::optional<QString> lastFault;
};

/// Of what ports.list gives a list: a port.
struct PortStatus {
    QString name, url, state, reason, device;
    quint64 opened = 0, failures = 0, bytes = 0;
    double bytesPerSecond = 0;
    quint64 sent = 0, lost = 0, viewLost = 0;
    QMap<QString, quint64> systemErrors;
    std::optional<double> lastStamp;
    std::optional<NmeaCounts> nmea;
    std::optional<std::optional<FixValues>> fix; ///< nothing: none came yet
};

/// The topic `serial`, and what source.status gives.
struct SerialMessage {
    std::vector<PortStatus> ports;
    bool recording = false;
    SourceStatus source;
};

/// What mark gives.
struct MarkAnswer {
    double stamp = 0, mono = 0;
};

/// Of what record.marks gives a list.
struct RecordedMark {
    double t_s = 0, stamp = 0;
    QString text;
};

/// What send gives.
struct SendAnswer {
    qint64 sent = 0;
};

/// What record.export gives.
struct ExportAnswer {
    QString path;
    quint64 rows = 0;
};

FixValues valuesOf(const Fix &fix);

Fields<LineMessage> fieldsOf(Of<LineMessage>);
Fields<NmeaCounts> fieldsOf(Of<NmeaCounts>);
Fields<PortStatus> fieldsOf(Of<PortStatus>);
Fields<SerialMessage> fieldsOf(Of<SerialMessage>);
Fields<MarkAnswer> fieldsOf(Of<MarkAnswer>);
Fields<RecordedMark> fieldsOf(Of<RecordedMark>);
Fields<SendAnswer> fieldsOf(Of<SendAnswer>);
Fields<ExportAnswer> fieldsOf(Of<ExportAnswer>);

} // namespace hermes::seriallogger
