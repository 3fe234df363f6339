// The scan matcher closes loops while the robot drives.
#include "MatcherFixture.h"
#include "tests/vectorlib/RingBuilding.h"

using namespace hermes;
using namespace hermes::scanmatcher;
using vectorlib::Pose2D;
using vectorlib::Transformation2D;

namespace {

Pose2D poseOf(const QJsonObject &json) {
    return {json["x"].toDouble(), json["y"].toDouble(), json["theta"].toDouble()};
}
double distance(const Pose2D &a, const Pose2D &b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

} // namespace

/// A robot on slipping wheels goes twice around a building whose rooms are alike; its scanner sees 5 m far.
class TestLiveLoops : public QObject, MatcherFixture {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void cleanup() { tearDown(); }
    void driveIsCorrectedWhileItGoesOn();
    void withoutClosingItStaysBent();
    void anotherMapForgetsTheDrive();

private:
    void drive(std::size_t from, std::size_t to);
    void waitForCorrector() {
        QTRY_COMPARE_WITH_TIMEOUT(call("matcher.state")["loops_waiting"].toInt(), 0, 60000);
        QTest::qWait(1200); // a pause after which all that was found counts
    }
    double worstAtRevisits() const;
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

void TestLiveLoops::init() {
    setUp();
    call("settings.set",
         {{"values",
           QJsonObject{{"odometry", QJsonObject{{"address", QString("127.0.0.1:%1").arg(sourcePort)}}}}}});
    QTRY_VERIFY(source->hasSubscribers("odometry"));
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
    const Pose2D start = way.front();
    call("pose.set", {{"x", start.x}, {"y", start.y}, {"theta", start.theta}});
}

// The odometry is a second ahead of the scans: nothing has to wait for it.
void TestLiveLoops::drive(std::size_t from, std::size_t to) {
    const ScanWorld::Scanner scanner{500, 1.99 * vectorlib::pi, 0.03, 5};
    constexpr std::size_t ahead = 10;
    const auto stampOf = [](std::size_t i) { return 1 + 0.1 * double(i); };
    for (std::size_t i = from; i < to; ++i) {
        for (; told < std::min(i + ahead, way.size()); ++told) {
            const QJsonObject wheel{
                {"x", wheels[told].x}, {"y", wheels[told].y}, {"theta", wheels[told].theta}};
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
        QDeadlineTimer patience(20000);
        while (poses.count(int(i)) == 0 && !patience.hasExpired())
            QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
        QVERIFY(poses.count(int(i)) > 0);
    }
}

// By the key scans as they lie now: each stands for the scan that is nearest in the true drive.
double TestLiveLoops::worstAtRevisits() const {
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

void TestLiveLoops::driveIsCorrectedWhileItGoesOn() {
    drive(0, way.size());
    waitForCorrector();
    poses.erase(int(way.size()) - 1);
    drive(way.size() - 1, way.size()); // it stands, and the pose comes again
    const QJsonObject state = call("matcher.state");
    int corrected = 0;
    double leap = 0;
    for (const auto &[number, pose] : poses) {
        corrected += pose["corrected"].toBool();
        if (pose["map_to_odometry"].isNull())
            continue;
        // Where the odometry is by the correction is where the pose is.
        const Pose2D sum = poseOf(pose["map_to_odometry"].toObject()) * wheels[std::size_t(number)];
        leap = std::max(leap, distance(sum, poseOf(pose)));
    }
    const double end = distance(poseOf(poses.rbegin()->second), way.back());
    qInfo("%zu scans, %d corrections, %d poses that leapt, %d of %d closed, longest stall %.2f ms, end %.3f "
          "m off, key "
          "scans %.3f m",
          way.size(), state["corrections"].toInt(), corrected, state["closures"].toInt(),
          state["closures_tried"].toInt(), state["longest_stall_ms"].toDouble(), end, worstAtRevisits());
    QVERIFY(state["corrections"].toInt() > 0);
    QVERIFY(corrected > 0 && corrected <= state["corrections"].toInt());
    QVERIFY(state["closures"].toInt() > 50);
    QCOMPARE(state["loops_dropped"].toInt(), 0);
    QVERIFY(state["by_odometry"].toInt() > int(way.size()) / 2);
    QVERIFY2(leap < 1e-6, qPrintable(QString::number(leap)));
    QVERIFY2(end < 0.10, qPrintable(QString::number(end)));
    QVERIFY(worstAtRevisits() < 0.20); // 30 cm lie between two poses of the way
    QVERIFY(graphs >= state["corrections"].toInt());
    QCOMPARE(graphPoses.size(), state["key_scans"].toInt());
    QCOMPARE(call("map.get")["size"].toInt(), state["map_segments"].toInt());
}

void TestLiveLoops::withoutClosingItStaysBent() {
    call("settings.set", {{"values", QJsonObject{{"matcher", QJsonObject{{"close_loops", false}}}}}});
    drive(0, way.size());
    QCOMPARE(call("matcher.state")["corrections"].toInt(), 0);
    QCOMPARE(call("matcher.state")["key_scans"].toInt(), 0);
    const double end = distance(poseOf(poses.rbegin()->second), way.back());
    qInfo("end %.3f m off", end);
    for (const auto &[number, pose] : poses)
        QVERIFY(!pose["corrected"].toBool());
}

// A correction of a drive that is over must not bring the old map back.
void TestLiveLoops::anotherMapForgetsTheDrive() {
    for (int round = 0; round < 4; ++round) {
        const std::size_t part = way.size() / 8;
        drive(part * std::size_t(round), part * std::size_t(round + 1));
        call("map.clear");
        QCOMPARE(call("matcher.state")["map_segments"].toInt(), 0);
        QTest::qWait(700);
        QCOMPARE(call("matcher.state")["map_segments"].toInt(), 0);
        QCOMPARE(call("matcher.state")["key_scans"].toInt(), 0);
        QTRY_COMPARE(graphPoses.size(), 0);
    }
}

QTEST_GUILESS_MAIN(TestLiveLoops)
#include "TestLiveLoops.moc"
