// What is kept while maps and places change: what map.undo brings back, and the live map during a replay.
#include "MatcherFixture.h"

using namespace hermes;
using vectorlib::Pose2D;

class TestMapHistory : public QObject, MatcherFixture {
    Q_OBJECT

    static vectorlib::VectorMap wall() {
        vectorlib::VectorMap map;
        vectorlib::EdgeRaw2D edge;
        edge.segment = {{0, 0}, {1, 0}};
        map.add(edge);
        return map;
    }
    static MapHistory::Step poseStep(const Pose2D &before, const Pose2D &told) {
        return {"pose.set", std::nullopt, true, before, told};
    }

private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void aCorrectionMovesWhatLiesInTheMapOfNow() {
        MapHistory history;
        history.add(poseStep({1, 0, 0}, {2, 0, 0})); // in the map that the next step keeps
        history.add(poseStep({3, 0, 0}, {4, 0, 0}));
        history.keepMap(wall());
        history.add(poseStep({5, 0, 0}, {6, 0, 0}));
        history.move(vectorlib::Transformation2D(0, 10, 0));
        for (const auto &[before, told] : {std::pair(10, 10), std::pair(0, 10), std::pair(0, 0)}) {
            const auto step = history.take(false);
            QCOMPARE(step->before.y, double(before));
            QCOMPARE(step->told.y, double(told));
        }
    }

    void whatIsGoneIsCounted() {
        MapHistory history;
        QCOMPARE(history.add({"map.clear", wall(), false, {}, {}}), std::size_t(0));
        history.put(*history.take(false), false);
        QCOMPARE(history.addReplay(wall()), std::size_t(0));
        QCOMPARE(history.next(true), QString("map.clear")); // a replay does not take that
        QCOMPARE(history.add(poseStep({}, {})), std::size_t(1));
        QVERIFY(history.next(true).isEmpty());
        std::size_t gone = 0;
        for (std::size_t i = 0; i < MapHistory::maxSteps; ++i)
            gone += history.add(poseStep({}, {}));
        QCOMPARE(gone, std::size_t(1)); // the map of the replay was the oldest
    }

    void thePlaceInAMapThatIsBackIsNotKnown() {
        MapHistory history;
        history.add(poseStep({1, 0, 0}, {2, 0, 0}));
        history.add({"map.clear", wall(), false, {}, {}});
        history.put(*history.take(false), false);
        QVERIFY(history.take(false)->place == vectorlib::PlaceState::Sought);
        QVERIFY(!history.take(false));
    }

    void undoBringsTheMapBack() {
        QVERIFY(failure("map.undo", {}).is(ErrorCode::NotReady));
        call("pose.set", {{"x", -1.5}, {"y", -0.5}, {"theta", 0.0}});
        drive(0, 10);
        const QJsonArray before = call("map.get")["edges"].toArray();
        QVERIFY(!before.isEmpty());
        QTRY_VERIFY(call("matcher.state")["key_scans"].toInt() > 0);
        call("map.clear");
        QCOMPARE(call("matcher.state")["key_scans"].toInt(), 0); // at once
        call("map.clear");                                       // an empty map replaces nothing
        QCOMPARE(call("map.undo")["segments"].toInt(), before.size());
        const QJsonArray back = call("map.get")["edges"].toArray();
        QCOMPARE(back.size(), before.size());
        for (int i = 0; i < back.size(); ++i)
            for (const char *member : {"x1", "y1", "x2", "y2", "n", "observations"})
                QCOMPARE(back[i].toObject()[member], before[i].toObject()[member]);
        QCOMPARE(call("matcher.state")["redoes"].toString(), QString("map.clear"));
        QCOMPARE(call("map.undo", {{"redo", true}})["segments"].toInt(), 0);
        QCOMPARE(call("map.undo")["command"].toString(), QString("map.clear"));
        QVERIFY(failure("map.load", {{"path", "none.csv"}}).is(ErrorCode::InputOutput)); // replaces nothing
        QCOMPARE(call("matcher.state")["undoes"].toString(), QString("pose.set"));
        drive(0, 10); // it is found in it, and the map stays the same room
        QCOMPARE(call("map.get")["size"].toInt(), before.size());
    }

    void undoBringsThePoseBack_data() {
        falseAndTrue("confirm", "a place that nothing agrees with", "a place that somebody insists on");
    }

    void undoBringsThePoseBack() {
        QFETCH(bool, confirm);
        call("pose.set", {{"x", -1.5}, {"y", -0.5}, {"theta", 0.0}});
        drive(0, 20);
        const QJsonArray before = call("map.get")["edges"].toArray();
        QJsonObject pose = call("map.undo", {{"redo", false}}); // the first pose.set: the frame is another
        QVERIFY(pose["map"].toBool() && pose["segments"].toInt() == 0);
        QCOMPARE(call("map.undo", {{"redo", true}})["segments"].toInt(), before.size());
        drive(0, 20);
        const int keyScans = call("matcher.state")["key_scans"].toInt();
        const QJsonArray room = call("map.get")["edges"].toArray();

        call("pose.set", {{"x", 1.5}, {"y", 6.5}, {"theta", -0.7}, {"confirm", confirm}});
        QCOMPARE(call("matcher.state")["undoes"].toString(), QString("pose.set"));
        drive(20, 30);
        QCOMPARE(call("map.get")["size"].toInt() > room.size(), confirm); // a second room
        pose = call("map.undo");
        QCOMPARE(pose["command"].toString(), QString("pose.set"));
        QVERIFY(pose["pose"].toBool());
        QCOMPARE(pose["map"].toBool(), confirm);
        QCOMPARE(call("map.get")["edges"].toArray().size(), room.size());
        const vectorlib::Pose2D truth = onTheWay(29); // it has driven on
        const QJsonObject at = pose["at"].toObject();
        QVERIFY2(std::hypot(at["x"].toDouble() - truth.x, at["y"].toDouble() - truth.y) < 0.1,
                 saying("%1 %2", at["x"].toDouble(), at["y"].toDouble()));
        QVERIFY(confirm || call("matcher.state")["key_scans"].toInt() >= keyScans); // the drive goes on
        int i = 30;
        const auto driveOn = [&] {
            source->publish("scan2d", roomScan(onTheWay(i), 0.1 * i), 0.1 * i);
            ++i;
        };
        while (i < 40)
            driveOn();
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), confirm ? 10 : 40); // of this map
        // It was found in a map that grows, and nearby: a second search decides.
        QTRY_VERIFY((driveOn(), call("matcher.state")["place"].toString() == "known"));
        QCOMPARE(call("map.get")["size"].toInt(), room.size());
        if (confirm) // what was undone is not lost either
            QVERIFY(call("map.undo", {{"redo", true}})["segments"].toInt() > room.size());
    }

    void eachUndoGoesOneStepBack() {
        call("pose.set", {{"x", -1.5}, {"y", -0.5}, {"theta", 0.0}});
        drive(0, 10);
        const int walls = call("map.get")["size"].toInt();
        call("map.save", {{"path", "room.csv"}});
        call("map.clear");
        call("map.load", {{"path", "room.csv"}}); // which replaces an empty map
        for (int i = 0; i < 20; ++i)
            call("pose.set", {{"x", 0.1 * i}, {"y", 0}, {"theta", 0}});
        for (int i = 0; i < 8; ++i)
            QCOMPARE(call("map.undo")["command"].toString(), QString("pose.set"));
        QVERIFY(failure("map.undo", {}).is(ErrorCode::NotReady)); // no further
        call("map.load", {{"path", "room.csv"}});
        call("pose.set", {{"x", 0}, {"y", 0}, {"theta", 0}});
        QCOMPARE(call("map.undo")["command"].toString(), QString("pose.set"));
        const QJsonObject loaded = call("map.undo");
        QCOMPARE(loaded["command"].toString(), QString("map.load"));
        QCOMPARE(loaded["segments"].toInt(), walls);
        call("pose.set", {{"x", 0}, {"y", 0}, {"theta", 0}});
        call("map.clear");
        QCOMPARE(call("map.undo")["segments"].toInt(), walls);
        QVERIFY(!call("map.undo")["pose"].toBool()); // where the sensor is in that map is not known
        QCOMPARE(call("matcher.state")["place"].toString(), QString("sought"));
        QVERIFY(failure("pose.set", {{"x", 1e15}, {"y", 0}, {"theta", 0}}).is(ErrorCode::InvalidParams));
    }

    void aReplayLeavesTheLiveMapAlone_data() {
        const Rows<QString, bool> row("mode", "isOfTopics");
        row("mapping", "mapping", false);
        row("localization", "localization", false);
        row("by topics.replay", "mapping", true);
    }

    void aReplayLeavesTheLiveMapAlone() {
        FETCH(QString, mode, bool, isOfTopics);
        call("pose.set", {{"x", -1.5}, {"y", -0.5}, {"theta", 0.0}});
        drive(0, 40);
        const QJsonArray live = call("map.get")["edges"].toArray();
        QCOMPARE(live.size(), 6);
        call("matcher.start", {{"mode", mode}});
        QTRY_VERIFY(source->hasSubscribers("scan2d"));
        int scans = call("matcher.state")["scans"].toInt();
        const bool isApart = mode == "mapping";
        ConnectedClient player(asOwner(source->server().addresses().value(0)));
        const auto replay = [&player](QJsonObject params) {
            params["topic"] = "scan2d";
            QVERIFY(player.callAndWait("topics.replay", params).ok());
        };
        for (int i = 0; i < 20; ++i) { // of long ago
            QJsonObject scan = roomScan(onTheWay(i), 0.1 * i);
            if (isOfTopics) {
                replay({{"data", scan}, {"stamp", 0.1 * i}});
                continue;
            }
            scan["replayed"] = true;
            source->publish("scan2d", scan, 0.1 * i);
        }
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), isApart ? 20 : scans + 20);
        if (isOfTopics)
            replay({{"live", true}});
        QTRY_VERIFY2(healthItem("replay")["message"].toString().contains("live map is kept") == isApart,
                     qPrintable(healthItem("replay")["message"].toString()));
        QTRY_COMPARE(healthItem("replay")["level"].toString(), QString("warn"));
        const QJsonArray replayed = call("map.get")["edges"].toArray();
        QCOMPARE(replayed == live, !isApart);
        QVERIFY(!replayed.isEmpty());

        if (!isApart)
            scans = call("matcher.state")["scans"].toInt();
        for (int i = 40; i < 65; ++i) // not as many as before
            source->publish("scan2d", roomScan(onTheWay(i), 0.1 * i), 0.1 * i);
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), scans + 25);
        const QJsonArray back = call("map.get")["edges"].toArray();
        QCOMPARE(back.size(), live.size());
        for (int i = 0; i < back.size(); ++i)
            for (const char *end : {"x1", "y1", "x2", "y2"})
                QVERIFY2(
                    std::abs(back[i][end].toDouble() - live[i][end].toDouble()) < 0.02,
                    saying("%1 %2: %3 and %4", i, end, back[i][end].toDouble(), live[i][end].toDouble()));
        QTRY_COMPARE(healthItem("replay")["level"].toString(), QString("ok"));
        QTRY_VERIFY(call("matcher.state")["matched"].toInt() > 10);
        if (isApart) // what the replay has mapped is not lost
            QCOMPARE(call("map.undo")["segments"].toInt(), replayed.size());
    }

    void mappingBegunDuringAReplay() {
        call("pose.set", {{"x", -1.5}, {"y", -0.5}, {"theta", 0.0}});
        drive(0, 40);
        const QJsonArray live = call("map.get")["edges"].toArray();
        const auto replay = [this] {
            for (int i = 0; i < 20; ++i) {
                QJsonObject scan = roomScan(onTheWay(i), 0.1 * i);
                scan["replayed"] = true;
                source->publish("scan2d", scan, 0.1 * i);
            }
        };
        for (const char *mode : {"localization", "mapping"}) {
            call("matcher.start", {{"mode", mode}});
            QTRY_VERIFY(source->hasSubscribers("scan2d"));
            replay();
            QTRY_VERIFY(healthItem("replay")["level"] == QJsonValue("warn"));
        }
        QTRY_VERIFY(healthItem("replay")["message"].toString().contains("live map is kept"));
        call("settings.set", {{"values", QJsonObject{{"matcher", QJsonObject{{"sigma_m", 0.02}}}}}});
        replay();
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), 40);
        source->publish("scan2d", roomScan(onTheWay(40), 4), 4);
        QTRY_VERIFY(healthItem("replay")["level"] == QJsonValue("ok"));
        QTRY_COMPARE(call("map.get")["size"].toInt(), live.size());
    }

    // Back to where it was, it is found in its map; where the map has nothing, another one begins.
    void aReplayThatIsSoughtGrowsNoGhost() {
        drive(0, 10);
        const auto replay = [this](int i, const vectorlib::Pose2D &pose) {
            QJsonObject scan = roomScan(pose, 0.1 * i);
            scan["replayed"] = true;
            source->publish("scan2d", scan, 0.1 * i);
        };
        const auto edges = [this] { return call("map.get")["size"].toInt(); };
        double gone_m = 0; // from where the replay began
        client_->subscribe("pose", {{"queue", 100}}, [&](const TopicUpdate &update) {
            gone_m = std::hypot(update.json()["x"].toDouble(), update.json()["y"].toDouble());
        });
        QTRY_VERIFY(matcher->hasSubscribers("pose"));
        for (int i = 0; i < 60; ++i) {
            replay(i, onTheWay(i));
            if (i % 20 == 19) // more would not wait
                QTRY_COMPARE(call("matcher.state")["scans"].toInt(), i + 1);
        }
        QCOMPARE(edges(), 6);
        QTRY_VERIFY2(std::abs(gone_m - std::hypot(0.05 * 59, 0.02 * 59)) < 0.1, saying(gone_m));
        for (int i = 5; i < 15; ++i) // 2.7 m and 1.6 rad from there
            replay(i, onTheWay(i));
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), 70);
        QTRY_VERIFY2(std::abs(gone_m - std::hypot(0.05 * 14, 0.02 * 14)) < 0.1, saying(gone_m));
        QCOMPARE(edges(), 6);
        // A corner that was never seen: as if the recording had gone on to another room.
        const auto corner = [this](int i) {
            QJsonArray x, y;
            for (int k = 0; k < 400; ++k) {
                x << (k < 200 ? 1.0 : 1.0 - 0.015 * (k - 200));
                y << (k < 200 ? -1.5 + 0.015 * k : 1.5);
            }
            source->publish(
                "scan2d",
                QJsonObject{{"stamp", 0.1 * i}, {"turn", i}, {"x", x}, {"y", y}, {"replayed", true}},
                0.1 * i);
        };
        int next = 300;
        const auto isMapped = [&] { // whatever was on its way when the new map began
            corner(next++);
            return edges() == 2;
        };
        QTRY_VERIFY_WITH_TIMEOUT(isMapped(), 20000);
        QVERIFY(call("matcher.state")["scans"].toInt() < 70);
        QVERIFY(healthItem("replay")["message"].toString().contains("live map is kept"));
    }
};
