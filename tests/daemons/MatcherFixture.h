#pragma once

#include "daemons/scanmatcher/ScanMatcher.h"
#include "tests/support/DaemonClient.h"

namespace hermes {

using namespace scanmatcher;

/// A daemon that publishes the scans and the odometry that a test tells it.
class ScanSource : public Daemon {
public:
    ScanSource()
        : Daemon({"scansource", "Scan source", "Publishes the scans and the odometry of a test"}) {
        addTopic(Topic("scan2d", "Scans"));
        addTopic(Topic("odometry", "Odometry"));
    }
    using Daemon::publish;
};

/// What a scanner without noise sees from a pose in a room of 8 m x 6 m with a niche.
inline QJsonObject roomScan(const vectorlib::Pose2D &pose, double stamp) {
    const std::vector<vectorlib::LineSegment2D<double>> walls{{{-4, -3}, {4, -3}}, {{4, -3}, {4, 3}},
                                                              {{4, 3}, {-1, 3}},   {{-1, 3}, {-1, 2}},
                                                              {{-1, 2}, {-4, 2}},  {{-4, 2}, {-4, -3}}};
    QJsonArray x, y;
    for (int i = 0; i < 1000; ++i) {
        const double angle = 2 * vectorlib::pi * i / 1000;
        const vectorlib::Vector2D<double> d(std::cos(pose.theta + angle), std::sin(pose.theta + angle)),
            from(pose.x, pose.y);
        double range = 1e9;
        for (const auto &wall : walls) {
            const double across = d.cross(wall.direction());
            const double r = (wall.begin() - from).cross(wall.direction()) / across;
            const double t = wall.along(from + d * r);
            if (std::abs(across) > 1e-9 && r > 0 && t >= -1e-9 && t <= wall.length() + 1e-9)
                range = std::min(range, r);
        }
        x.append(range * std::cos(angle));
        y.append(range * std::sin(angle));
    }
    return {{"stamp", stamp}, {"turn", std::round(10 * stamp)}, {"x", x}, {"y", y}};
}

inline vectorlib::Pose2D onTheWay(int i) {
    return {-1.5 + 0.05 * i, -0.5 + 0.02 * i, 0.03 * i};
}

/// A scan matcher with a source of scans and a client, all in the process of the test.
class MatcherFixture : protected DaemonClient {
protected:
    void setUp();
    void tearDown();
    void startSource(quint16 port);
    QJsonObject call(const QString &method, const QJsonObject &params = {}) {
        return DaemonClient::call(method, params).toObject();
    }

    /// Scans of the room on the way, from that number to before this one.
    void drive(int from, int to) {
        for (int i = from; i < to; ++i)
            source->publish("scan2d", roomScan(onTheWay(i), 0.1 * i), 0.1 * i);
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), to);
    }

    std::unique_ptr<QTemporaryDir> folder;
    std::unique_ptr<ScanSource> source;
    std::unique_ptr<ScanMatcher> matcher;
    quint16 sourcePort = 0;
};

inline void MatcherFixture::startSource(quint16 port) {
    source = std::make_unique<ScanSource>();
    launch(*source, {"limits.topic_bytes=100000000"}, QString("tcp://127.0.0.1:%1").arg(port));
    sourcePort = quint16(QUrl(source->server().addresses().value(0)).port());
}

inline void MatcherFixture::setUp() {
    folder = std::make_unique<QTemporaryDir>();
    startSource(0);
    matcher = std::make_unique<ScanMatcher>();
    launch(*matcher, {QString("source.address=127.0.0.1:%1").arg(sourcePort), "map.folder=" + folder->path(),
                      "map.journal=drive.journal"});
    connectTo(*matcher);
    QTRY_VERIFY(source->hasSubscribers("scan2d"));
}

inline void MatcherFixture::tearDown() {
    client_.reset();
    matcher->shutDown();
    matcher.reset();
    if (source)
        source->shutDown();
    source.reset();
}

} // namespace hermes
