// The scan matcher closes loops while the robot drives.
#include "RingDrive.h"

using namespace hermes;
using namespace hermes::scanmatcher;

class TestLiveLoops : public QObject, RingDrive {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void cleanup() { tearDown(); }
    void driveIsCorrectedWhileItGoesOn();
    void withoutClosingItStaysBent();
    void anotherMapForgetsTheDrive();

private:
    void waitForCorrector() {
        QTRY_COMPARE_WITH_TIMEOUT(call("matcher.state")["loops_waiting"].toInt(), 0, 60000);
        QTest::qWait(1200); // a pause after which all that was found counts
    }
};

void TestLiveLoops::init() {
    setUp();
    call("settings.set",
         {{"values",
           QJsonObject{{"odometry", QJsonObject{{"address", QString("127.0.0.1:%1").arg(sourcePort)}}}}}});
    QTRY_VERIFY(source->hasSubscribers("odometry"));
    prepare();
    listen();
    const Pose2D start = way.front();
    call("pose.set", {{"x", start.x}, {"y", start.y}, {"theta", start.theta}});
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
