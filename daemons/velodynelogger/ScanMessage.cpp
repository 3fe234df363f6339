#include "daemons/velodynelogger/ScanMessage.h"

#include <QJsonArray>

#include <cmath>

namespace hermes {

namespace {

/// Short numbers make short messages; the sensor counts 2 mm.
double rounded(double value, double perUnit) {
    return std::round(value * perUnit) / perUnit;
}

/// "1700000000.123456789": more digits than a double has.
QByteArray toSeconds(std::int64_t stamp_ns) {
    const std::int64_t second_ns = 1000000000;
    return QByteArray::number(qint64(stamp_ns / second_ns)) + '.' +
           QByteArray::number(qint64(stamp_ns % second_ns)).rightJustified(9, '0');
}

} // namespace

QJsonObject toScanMessage(const velodyne::Turn &turn) {
    QJsonArray x, y, t, intensity;
    for (auto point = turn.points.rbegin(); point != turn.points.rend(); ++point) {
        x.append(rounded(point->x, 1e5));
        y.append(rounded(point->y, 1e5));
        t.append(rounded(double(point->stamp_ns - turn.begin_ns) * 1e-9, 1e6));
        intensity.append(point->intensity);
    }
    return {{"turn", double(turn.number)},
            {"stamp", double(turn.begin_ns) * 1e-9},
            {"duration_s", double(turn.end_ns - turn.begin_ns) * 1e-9},
            {"partial", turn.partial},
            {"lost_packets", double(turn.lostPackets)},
            {"frame", "lidar"},
            {"laser", turn.laser},
            {"x", x},
            {"y", y},
            {"t", t},
            {"intensity", intensity}};
}

QByteArray toCsv(const velodyne::Turn &turn) {
    QByteArray csv = "turn,stamp,laser,azimuth,range,intensity,x,y,z\n";
    const QByteArray number = QByteArray::number(qulonglong(turn.number)) + ',';
    const auto metres = [](double value) { return ',' + QByteArray::number(value, 'f', 5); };
    for (const velodyne::Point &point : turn.points) {
        csv += number + toSeconds(point.stamp_ns) + ',' + QByteArray::number(point.laser) + ',' +
               QByteArray::number(point.azimuth, 'f', 4) + ',' + QByteArray::number(point.range, 'f', 3) +
               ',' + QByteArray::number(point.intensity) + metres(point.x) + metres(point.y) +
               metres(point.z) + '\n';
    }
    return csv;
}

} // namespace hermes
