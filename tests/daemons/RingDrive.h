#pragma once

#include "MatcherFixture.h"
#include "tests/vectorlib/RingBuilding.h"

namespace hermes {

using vectorlib::Pose2D;
using vectorlib::Transformation2D;

inline Pose2D poseOf(const QJsonObject &json) {
    return {json["x"].toDouble(), json["y"].toDouble(), json["theta"].toDouble()};
}
inline double distance(const Pose2D &a, const Pose2D &b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

/// A robot on slipping wheels goes twice around a building whose rooms are alike; its scanner sees 5 m far.
class RingDrive : protected MatcherFixture {
protected:
    /// With a matcher that takes the odometry, too.
    void begin();
    void prepare();
    /// To what the matcher tells.
    void listen();
    void drive(std::size_t from, std::size_t to);
    /// One scan, and the odometry until a second after it.
    void tell(std::size_t i);
    /// Until every scan is looked at and the map made anew where loops say that it has to be.
    void waitForCorrector();
    /// How far the key scan that lies worst is from the way that was driven; metres.
    double farthestFromTheWay() const;
    static QJsonArray numbers(const std::vector<vectorlib::Vector2D<float>> &points, bool ofX) {
        QJsonArray array;
        for (const auto &p : points)
            array.append(double(ofX ? p.x : p.y));
        return array;
    }

    std::mt19937 random;
    std::unique_ptr<RingBuilding> building;
    std::vector<Pose2D> way, wheels;
    std::map<int, QJsonObject> poses; // by number of the turn
    QJsonArray graphPoses;
    int graphs = 0;
    std::size_t told = 0; // of the odometry
};

inline void RingDrive::begin() {
    setUp();
    call("settings.set",
         {{"values",
           QJsonObject{{"odometry", QJsonObject{{"address", QString("127.0.0.1:%1").arg(sourcePort)}}}}}});
    QTRY_VERIFY(source->hasSubscribers("odometry"));
    prepare();
    listen();
}

inline void RingDrive::prepare() {
    random.seed(11);
    building = std::make_unique<RingBuilding>(random);
    way = building->drive(2);
    wheels = {{5, 5, 1}};
    std::normal_distribution<double> noise;
    for (std::size_t i = 1; i < way.size(); ++i) {
        const Pose2D m = way[i - 1].inverse() * way[i];
        const double slip = 1 + 0.05 * noise(random);
        wheels.push_back(wheels.back() *
                         Pose2D{m.x * slip, m.y * slip, m.theta * (1 + 0.05 * noise(random)) + 0.004});
    }
}

inline void RingDrive::listen() {
    poses.clear();
    client_->subscribe("pose", {{"queue", 10000}}, [this](const TopicUpdate &update) {
        const QJsonObject pose = update.json().toObject();
        poses[pose["scan"].toInt()] = pose;
    });
    graphs = 0;
    told = 0;
    graphPoses = {};
    client_->subscribe("graph", {{"queue", 10000}}, [this](const TopicUpdate &update) {
        const QJsonObject graph = update.json().toObject();
        graphs += graph["cleared"].toBool();
        while (graphPoses.size() > graph["first"].toInt())
            graphPoses.removeLast();
        for (const QJsonValue &p : graph["poses"].toArray())
            graphPoses.append(p);
    });
}

// The odometry is a second ahead of the scans: nothing has to wait for it.
inline void RingDrive::tell(std::size_t i) {
    const ScanWorld::Scanner scanner{500, 1.99 * vectorlib::pi, 0.03, 5};
    constexpr std::size_t ahead = 10;
    const auto stampOf = [](std::size_t number) { return 1 + 0.1 * double(number); };
    for (; told < std::min(i + ahead, way.size()); ++told) {
        const QJsonObject wheel{{"x", wheels[told].x}, {"y", wheels[told].y}, {"theta", wheels[told].theta}};
        const Pose2D &next = wheels[std::min(told + 1, wheels.size() - 1)];
        const vectorlib::Twist2D twist = vectorlib::Twist2D::between(wheels[told].inverse() * next, 0.1);
        const QJsonObject speed{{"vx", twist.vx}, {"vy", twist.vy}, {"omega", twist.omega}};
        const double v = 1e-4 * stampOf(told);
        source->publish("odometry",
                        QJsonObject{{"pose", wheel},
                                    {"twist", speed},
                                    {"covariance", QJsonArray{v, 0, 0, 0, v, 0, 0, 0, v}}},
                        stampOf(told));
    }
    const auto points = building->world.scan(Transformation2D(way[i]), random, scanner);
    source->publish("scan2d",
                    QJsonObject{{"stamp", stampOf(i)},
                                {"turn", qint64(i)},
                                {"rays", scanner.rays},
                                {"x", numbers(points, true)},
                                {"y", numbers(points, false)}},
                    stampOf(i));
}

inline void RingDrive::drive(std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
        poses.erase(int(i)); // where it is driven again
        tell(i);
        QDeadlineTimer timeout(20000);
        while (poses.count(int(i)) == 0 && !timeout.hasExpired())
            QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
        QVERIFY(poses.count(int(i)) > 0);
    }
}

inline void RingDrive::waitForCorrector() {
    const auto isDone = [this] {
        const QJsonObject state = call("matcher.state");
        return state["loops_waiting"].toInt() == 0 && state["correction"] == QJsonValue("none");
    };
    QVERIFY(QTest::qWaitFor(isDone, 60000 * patience)); // asked no more: the last scan may come now
}

inline double RingDrive::farthestFromTheWay() const {
    double worst = 0;
    for (const QJsonValue &key : graphPoses) {
        const Pose2D found{key.toArray()[0].toDouble(), key.toArray()[1].toDouble(), 0};
        double nearest = 1e9;
        for (const Pose2D &p : way)
            nearest = std::min(nearest, distance(p, found));
        worst = std::max(worst, nearest);
    }
    return worst;
}

} // namespace hermes
