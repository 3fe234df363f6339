#pragma once

#include "protocol/wire/FieldsOf.h"

#include <QString>
#include <optional>
#include <vector>

namespace hermes {

/// What is told of every turn of a lidar.
struct TurnHeader {
    quint64 turn = 0;
    double stamp = 0; ///< of its first firing, seconds since the epoch
    double duration_s = 0;
    bool partial = false;
    std::optional<quint64> rays; ///< a logger that does not tell: as many as there are points
    quint64 lostPackets = 0;
    QString frame;
    bool replayed = false;
    std::optional<QString> clock; ///< that the stamp is of: gps, host, or the sensor's own
    std::optional<double> clockError_s;
};

/// The topic `scan2d`: the points of one laser in one turn, COUNTER-CLOCKWISE, as the vector library wants
/// them. Lengths and times are floats: who reads floats gets what `hermes-vector map` gets of the same
/// packets.
struct ScanMessage {
    static constexpr std::size_t maxPoints = 1000000;

    TurnHeader header;
    int laser = 0;
    std::vector<float> x, y;
    std::optional<std::vector<float>> t;
    std::vector<quint8> intensity;
};

/// The topic `cloud`: the points of all lasers in one turn, thinned, in the order of measuring.
struct CloudMessage {
    TurnHeader header;
    QString model;
    std::vector<float> x, y, z;
    std::vector<quint16> laser;
    std::vector<quint8> intensity;
};

Fields<TurnHeader> fieldsOf(Of<TurnHeader>);
Fields<ScanMessage> fieldsOf(Of<ScanMessage>);
Fields<CloudMessage> fieldsOf(Of<CloudMessage>);

} // namespace hermes
