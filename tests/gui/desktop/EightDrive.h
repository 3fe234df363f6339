#pragma once

#include <QPointF>

namespace hermes {

/// What a matcher says of a drive along an eight with walls on both sides, whose heading drifts until a loop
/// is closed.
class EightDrive {
public:
    static constexpr int keyScans = 120;

    struct Pose {
        double x, y, theta;
    };

    explicit EightDrive(double drift)
        : drift_(drift) {}

    /// Of a key scan; beyond the last of them the robot drives on.
    Pose pose(double number) const {
        const double way = 2 * M_PI * number / keyScans, bend = drift_ * number / keyScans;
        const double x = 20 * std::sin(way), y = 10 * std::sin(2 * way);
        const double heading = std::atan2(20 * std::cos(2 * way), 20 * std::cos(way));
        return {x * std::cos(bend) - y * std::sin(bend), x * std::sin(bend) + y * std::cos(bend),
                std::remainder(heading + bend, 2 * M_PI)};
    }
    QPointF wall(int keyScan, double along, double aside) const {
        const Pose p = pose(keyScan);
        return {p.x + along * std::cos(p.theta) - aside * std::sin(p.theta),
                p.y + along * std::sin(p.theta) + aside * std::cos(p.theta)};
    }

    /// The topic graph, a part of it: key scans from first up to end of size.
    QByteArray graph(int revision, bool isCleared, int first, int end, int size,
                     const QByteArray &loops) const {
        QByteArray poses, trust;
        for (int i = first; i < end; ++i) {
            const Pose p = pose(i);
            poses += list({p.x, p.y, p.theta}) + (i + 1 < end ? "," : "");
            trust += number(1 - 0.9 * i / keyScans) + (i + 1 < end ? "," : "");
        }
        return "{\"revision\":" + QByteArray::number(revision) + ",\"cleared\":" + truth(isCleared) +
               ",\"first\":" + QByteArray::number(first) + ",\"poses\":[" + poses + "],\"trust\":[" + trust +
               "],\"loops\":[" + loops + "],\"size\":" + QByteArray::number(size) + '}';
    }
    /// The topic map, all of it: two walls beside each key scan.
    QByteArray map(int revision) const {
        QByteArray edges;
        for (int i = 0; i < keyScans; ++i)
            for (const double side : {-1.5, 1.5}) {
                const QPointF a = wall(i, -0.5, side), b = wall(i, 0.5, side);
                edges += (edges.isEmpty() ? "{\"id\":" : ",{\"id\":") +
                         QByteArray::number(2 * i + (side > 0)) + ",\"x1\":" + number(a.x()) +
                         ",\"y1\":" + number(a.y()) + ",\"x2\":" + number(b.x()) +
                         ",\"y2\":" + number(b.y()) + '}';
            }
        return "{\"revision\":" + QByteArray::number(revision) + ",\"cleared\":true,\"edges\":[" + edges +
               "],\"removed\":[],\"size\":" + QByteArray::number(2 * keyScans) + '}';
    }
    /// The topic pose; the odometry is that of a drive with so much drift.
    QByteArray poseMessage(double keyScan, bool isCorrected, const EightDrive &odometry) const {
        const Pose p = pose(keyScan);
        const double bend = (drift_ - odometry.drift_) * keyScan / keyScans; // about the origin
        return "{\"x\":" + number(p.x) + ",\"y\":" + number(p.y) + ",\"theta\":" + number(p.theta) +
               ",\"covariance\":null,\"outcome\":\"matched\",\"trust\":0.87,\"corrected\":" +
               truth(isCorrected) + ",\"map_to_odometry\":{\"x\":0,\"y\":0,\"theta\":" + number(bend) + "}}";
    }

private:
    static QByteArray number(double value) { return QByteArray::number(value, 'g', 17); }
    static QByteArray truth(bool value) { return value ? "true" : "false"; }
    static QByteArray list(std::initializer_list<double> values) {
        QByteArray text;
        for (const double value : values)
            text += (text.isEmpty() ? "[" : ",") + number(value);
        return text + ']';
    }

    const double drift_; // radians after all key scans
};

} // namespace hermes
