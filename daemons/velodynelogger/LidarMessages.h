#pragma once

#include "protocol/messages/Recordings.h"

namespace hermes::velodynelogger {

/// What the position packets of the sensor tell; nothing of it before the first.
struct LidarGps {
    std::optional<QString> pps, nmea;
    std::optional<bool> valid, locked;
    std::optional<quint64> packets, wrongValue, badNmea;
    std::optional<double> utc, latitude_deg, longitude_deg;
};

/// The topic `lidar`, and what source.status gives.
struct LidarMessage {
    SourceStatus source;
    std::optional<QString> model, sensor;
    double rpm = 0, packetRate_hz = 0;
    LidarGps gps;
    quint64 packets = 0, turns = 0, lost = 0, gaps = 0, outOfOrder = 0, clockJumps = 0;
    quint64 wrongSize = 0, wrongFlag = 0, wrongValue = 0, otherModel = 0, otherSensors = 0;
    quint64 positionPackets = 0, otherDatagrams = 0, kernelDrops = 0, decoderDrops = 0;
    qint64 receiveBufferBytes = 0;
    quint64 turnsDropped = 0, cloudsDropped = 0;
    RecordingStatus recording;
};

/// What capture.turn gives.
struct CapturedTurn {
    QString path;
    quint64 points = 0;
};

Fields<LidarGps> fieldsOf(Of<LidarGps>);
Fields<LidarMessage> fieldsOf(Of<LidarMessage>);
Fields<CapturedTurn> fieldsOf(Of<CapturedTurn>);

} // namespace hermes::velodynelogger
