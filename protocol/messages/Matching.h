#pragma once

#include "protocol/messages/Motion.h"

#include <QString>
#include <array>
#include <optional>
#include <vector>

namespace hermes {

/// The topic `pose`: where the sensor is after a scan, in the map's frame.
struct PoseMessage {
    Pose2D pose;
    Twist2D twist;
    std::optional<Covariance> covariance;
    QString outcome;
    quint64 scan = 0;
    double trust = 0;
    bool corrected = false;
    bool upsideDown = false;
    std::optional<Pose2D> odometryFrame;
};

/// Milliseconds of each step of matching a scan.
struct StepTimes {
    double segment = 0, vectorize = 0, match = 0, map = 0;
};

/// The topic `match`: how a scan was matched.
struct MatchMessage {
    quint64 scan = 0;
    bool accepted = false;
    std::vector<std::array<qint64, 2>> pairs;
    double reliability = 0, ambiguity = 0;
    double matchedLength = 0, visibleLength = 0;
    double rms = 0;
    StepTimes ms;
};

/// The topic `segments`: x1, y1, x2, y2 of each line of a scan in the map's frame (m).
using SegmentsMessage = std::vector<std::array<double, 4>>;

/// The topic `scan`: all of it together.
struct ScanResult {
    double stamp = 0;
    PoseMessage pose;
    MatchMessage match;
    SegmentsMessage segments;
};

Fields<PoseMessage> fieldsOf(Of<PoseMessage>);
Fields<StepTimes> fieldsOf(Of<StepTimes>);
Fields<MatchMessage> fieldsOf(Of<MatchMessage>);
Fields<ScanResult> fieldsOf(Of<ScanResult>);

} // namespace hermes
