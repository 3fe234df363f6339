// The scan matcher closes loops while the robot drives.
#include "RingDrive.h"

using namespace hermes;

class TestLiveLoops : public QObject, RingDrive {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        begin();
        const Pose2D start = way.front();
        call("pose.set", {{"x", start.x}, {"y", start.y}, {"theta", start.theta}});
    }

    void cleanup() { tearDown(); }

    void driveIsCorrectedWhileItGoesOn() {
        drive(0, way.size());
        waitForCorrector();
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
        qInfo("%zu scans, %d corrections, %d poses that leapt, %d of %d closed, longest stall %.2f ms, end "
              "%.3f "
              "m off, key "
              "scans %.3f m",
              way.size(), state["corrections"].toInt(), corrected, state["closures"].toInt(),
              state["closures_tried"].toInt(), state["longest_stall_ms"].toDouble(), end,
              farthestFromTheWay());
        QVERIFY(state["corrections"].toInt() > 0);
        QVERIFY(corrected > 0 && corrected <= state["corrections"].toInt());
        QVERIFY(state["closures"].toInt() > 50);
        QCOMPARE(state["loops_dropped"].toInt(), 0);
        QVERIFY(state["by_odometry"].toInt() > int(way.size()) / 2);
        QVERIFY2(leap < 1e-6, saying(leap));
        QVERIFY2(end < 0.10, saying(end));
        QVERIFY(farthestFromTheWay() < 0.20); // 30 cm lie between two poses of the way
        QVERIFY(graphs >= state["corrections"].toInt());
        QCOMPARE(graphPoses.size(), state["key_scans"].toInt());
        QCOMPARE(call("map.get")["size"].toInt(), state["map_segments"].toInt());
    }

    void withoutClosingItStaysBent() {
        call("settings.set", {{"values", QJsonObject{{"matcher", QJsonObject{{"close_loops", false}}}}}});
        drive(0, way.size());
        waitForCorrector();
        QCOMPARE(call("matcher.state")["corrections"].toInt(), 0);
        QCOMPARE(call("matcher.state")["key_scans"].toInt(), 0);
        const double end = distance(poseOf(poses.rbegin()->second), way.back());
        qInfo("end %.3f m off", end);
        QVERIFY2(end > 0.05, saying(end));
        for (const auto &[number, pose] : poses)
            QVERIFY(!pose["corrected"].toBool());
    }

    // Key scans, loops, poses, counts and journal of the live drive rest meanwhile, and go on behind it.
    void aReplayLeavesTheDriveAlone() {
        const std::size_t rest = way.size() - 10;
        drive(0, rest);
        waitForCorrector();
        const QJsonObject before = call("matcher.state");
        QVERIFY(before["closures"].toInt() > 20 && before["key_scans"].toInt() > 20);
        const QJsonArray graph = graphPoses, live = call("map.get")["edges"].toArray();
        for (int i = 0; i < 20; ++i) { // of a small room
            QJsonObject scan = roomScan(onTheWay(i), 0.1 * i);
            scan["replayed"] = true;
            source->publish("scan2d", scan, 0.1 * i);
        }
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), 20);
        QTRY_VERIFY(healthItem("replay")["message"].toString().contains("with its drive"));
        QTRY_COMPARE(graphPoses.size(), 0); // it is not of the map that is shown
        QVERIFY(call("map.get")["edges"].toArray() != live);
        QVERIFY(failure("map.load", {{"path", "drive.journal"}}).message.contains("replay"));
        call("map.clear"); // that of the replay
        for (const char *member : {"key_scans", "closures", "corrections"})
            QCOMPARE(call("matcher.state")[member], before[member]);

        tell(rest);
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), int(rest) + 1);
        QTRY_COMPARE(graphPoses, graph);
        QCOMPARE(call("matcher.state")["key_scans"], before["key_scans"]);
        QVERIFY(std::abs(call("map.get")["size"].toInt() - live.size()) < 5);
        drive(rest + 1, way.size());
        QTRY_COMPARE(call("matcher.state")["place"].toString(), QString("known"));
        waitForCorrector();
        const double end = distance(poseOf(poses.rbegin()->second), way.back());
        QVERIFY2(end < 0.2, saying(end));
        QVERIFY(call("matcher.state")["closures"].toInt() >= before["closures"].toInt());
        client_.reset();
        matcher->shutDown();
        QCOMPARE(QDir(folder->path()).entryList({"*.journal"}), QStringList("drive.journal")); // of one drive
    }

    void anotherMapForgetsTheDrive() {
        for (int trial = 0; trial < 10; ++trial) {
            if (clearsInTime() || QTest::currentTestFailed())
                return;
            tearDown();
            init();
        }
        QFAIL("the map was never cleared while it was made anew");
    }

    void aFullMemoryTakesNoMore_data() {
        const Rows<double, bool> row("most", "corrects"); // most: MB
        row("before any loop", 0.3, false);
        row("where a loop is closed", 1.0, true);
        row("later", 1.3, true);
    }

    // The drive goes on in the map that it has.
    void aFullMemoryTakesNoMore() {
        FETCH(double, most, bool, corrects);
        const auto limit = [&](double mb) {
            call("settings.set", {{"values", QJsonObject{{"matcher", QJsonObject{{"remember_mb", mb}}}}}});
        };
        limit(most);
        drive(0, way.size());
        waitForCorrector();
        const QJsonObject full = call("matcher.state");
        const double end = distance(poseOf(poses.rbegin()->second), way.back());
        qInfo("%.2f MB, %d key scans, %d corrections, end %.3f m off", full["remembered_mb"].toDouble(),
              full["key_scans"].toInt(), full["corrections"].toInt(), end);
        QVERIFY(full["memory_full"].toBool());
        QVERIFY(full["remembered_mb"].toDouble() >= most && full["remembered_mb"].toDouble() < most + 0.02);
        QCOMPARE(full["corrections"].toInt() > 0, corrects);
        QCOMPARE(full["scans"].toInt(), int(way.size()));
        QVERIFY2(end < 0.30, saying(end));
        QTRY_COMPARE(graphPoses.size(), full["key_scans"].toInt());
        QCOMPARE(call("map.get")["size"].toInt(), full["map_segments"].toInt());
        QCOMPARE(healthItem("memory")["level"].toString(), QString("warn"));

        limit(300); // a drive with a gap is of no use
        drive(way.size() - 40, way.size());
        waitForCorrector();
        QVERIFY(call("matcher.state")["memory_full"].toBool());
        QCOMPARE(call("matcher.state")["key_scans"].toInt(), full["key_scans"].toInt());
        for (const bool closes : {false, true}) // another drive, in this map
            call("settings.set",
                 {{"values", QJsonObject{{"matcher", QJsonObject{{"close_loops", closes}}}}}});
        drive(way.size() - 40, way.size());
        waitForCorrector();
        const QJsonObject anew = call("matcher.state");
        QVERIFY(!anew["memory_full"].toBool());
        QVERIFY(anew["key_scans"].toInt() > 0 && anew["key_scans"].toInt() < full["key_scans"].toInt());
        QVERIFY(anew["map_segments"].toInt() >= full["map_segments"].toInt() - 10);
        QCOMPARE(healthItem("memory")["level"].toString(), QString("ok"));
    }

private:
    // A correction of a drive that is over must not bring the old map back. False where it was made before
    // the map was cleared: then this shows nothing.
    bool clearsInTime() {
        std::size_t scans = way.size() / 4;
        drive(0, scans);
        QJsonObject before;
        const auto stateIs = [&](const char *state) {
            before = call("matcher.state");
            return before["correction"] == QJsonValue(state);
        };
        for (; !stateIs("due") && !stateIs("running") && scans < way.size(); ++scans)
            drive(scans, scans + 1);
        QDeadlineTimer timeout(5000 * patience);
        while (!stateIs("running") && !timeout.hasExpired())
            ; // the map is made anew after a pause
        call("map.clear");
        const int cleared = call("matcher.state")["map_segments"].toInt();
        waitForCorrector();
        const auto isForgotten = [this] { return call("matcher.state")["key_scans"].toInt() == 0; };
        const bool forgets = QTest::qWaitFor(isForgotten, 10000 * patience) &&
                             QTest::qWaitFor([this] { return graphPoses.isEmpty(); }, 10000 * patience);
        const QJsonObject after = call("matcher.state");
        const bool inTime =
            before["correction"] == QJsonValue("running") && after["corrections"] == before["corrections"];
        qInfo("%zu scans, %d corrections before, %d after", scans, before["corrections"].toInt(),
              after["corrections"].toInt());
        [&] {
            QCOMPARE(cleared, 0);
            QCOMPARE(after["map_segments"].toInt(), 0);
            QVERIFY(forgets);
            drive(scans, std::min(scans + 20, way.size())); // it goes on
            waitForCorrector();
            QVERIFY(call("matcher.state")["map_segments"].toInt() > 0);
            QVERIFY(call("matcher.state")["key_scans"].toInt() > 0);
        }();
        return inTime;
    }
};
