#include "MatcherFixture.h"
#include "common/Log.h"

#include <future>

using namespace hermes;

class TestScanMatcher : public QObject, MatcherFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void tracksAndMaps() {
        call("pose.set", {{"x", -1.5}, {"y", -0.5}, {"theta", 0.0}});
        QJsonObject last;
        client_->subscribe("pose", {{"queue", 100}},
                           [&](const TopicUpdate &update) { last = update.json().toObject(); });
        QTRY_VERIFY(matcher->hasSubscribers("pose"));
        drive(0, 40);
        QTRY_COMPARE(last["scan"].toInt(), 39);
        const vectorlib::Pose2D truth = onTheWay(39);
        QVERIFY(std::hypot(last["x"].toDouble() - truth.x, last["y"].toDouble() - truth.y) < 0.01);
        QVERIFY(std::abs(last["theta"].toDouble() - truth.theta) < 0.005);
        QCOMPARE(last["outcome"].toString(), QString("matched"));
        QCOMPARE(last["covariance"].toArray().size(), 9);
        QVERIFY(std::abs(last["twist"].toObject()["omega"].toDouble() - 0.3) < 0.05);
        const QJsonObject state = call("matcher.state");
        QCOMPARE(state["matched"].toInt(), 40);
        QCOMPARE(state["dropped"].toInt(), 0);
        QCOMPARE(call("map.get")["edges"].toArray().size(), 6);
        QCOMPARE(call("daemon.status")["state"].toString(), QString("running"));
    }

    void savedMapLoadsTheSame() {
        drive(0, 10);
        const QJsonObject saved = call("map.save", {{"path", "room.csv"}});
        QCOMPARE(saved["path"].toString(), folder->filePath("room.csv"));
        const QJsonArray before = call("map.get")["edges"].toArray();
        call("map.clear");
        QCOMPARE(call("map.get")["size"].toInt(), 0);
        QCOMPARE(call("map.load", {{"path", "room.csv"}})["segments"].toInt(), before.size());
        const QJsonArray after = call("map.get")["edges"].toArray();
        QCOMPARE(after.size(), before.size());
        for (int i = 0; i < after.size(); ++i)
            for (const char *member : {"x1", "y1", "x2", "y2", "n", "sigma", "observations"})
                QCOMPARE(after[i].toObject()[member], before[i].toObject()[member]);
        for (const char *format : {"svg", "geojson", "dxf"})
            QVERIFY(call("map.export", {{"format", format}, {"path", QString("room.") + format}})["bytes"]
                        .toInt() > 300);
    }

    void whatIsInNoFileIsTold() {
        const auto isSaved = [this] { return healthItem("map")["values"].toObject()["saved"].toBool(); };
        QVERIFY(isSaved()); // an empty one
        drive(0, 3);
        QVERIFY(!isSaved());
        call("map.export", {{"path", "room.svg"}, {"format", "svg"}}); // from which it is not loaded
        QVERIFY(!isSaved());
        call("map.save", {{"path", "room.csv"}});
        QVERIFY(isSaved());
        failure("map.save", {{"path", "room.csv"}});
        QTRY_VERIFY(!isSaved()); // for all that is known
        call("map.load", {{"path", "room.csv"}});
        QVERIFY(isSaved());
        call("map.clear");
        drive(0, 3);
        client_.reset();
        matcher->shutDown();
        const std::vector<LogMessage> log = Log::instance().tail(10);
        QVERIFY(std::any_of(log.begin(), log.end(), [](const LogMessage &one) {
            return one.source == "map" && one.text.contains("segments is in no file");
        }));
    }

    void refusesToOverwriteAndNamesThePath() {
        drive(0, 3);
        call("map.save", {{"path", "room.csv"}});
        const Error exists = failure("map.save", {{"path", "room.csv"}});
        QVERIFY(exists.is(ErrorCode::InputOutput));
        QCOMPARE(exists.data.toObject()["path"].toString(), folder->filePath("room.csv"));
        QVERIFY(call("map.save", {{"path", "room.csv"}, {"force", true}}).contains("bytes"));
        const Error nowhere = failure("map.save", {{"path", "no/such/folder/room.csv"}});
        QVERIFY(nowhere.is(ErrorCode::InputOutput));
        QVERIFY(nowhere.data.toObject()["path"].toString().endsWith("no/such/folder/room.csv"));
        QCOMPARE(QDir(folder->path()).entryList(QDir::Files), QStringList("room.csv"));
    }

    void fullDiskLeavesNoFile() {
        drive(0, 3);
        std::optional<FileSizeLimit> disk(100);
        const Error map = failure("map.save", {{"path", "room.csv"}});
        const auto settings = matcher->settings().save(folder->filePath("settings.json"));
        disk.reset();
        QVERIFY2(map.is(ErrorCode::InputOutput), qPrintable(map.message));
        QVERIFY(!settings.ok());
        QVERIFY(QDir(folder->path()).entryList(QDir::Files).isEmpty());
    }

    void loadOfABadFileNamesTheLine() {
        drive(0, 3);
        put(folder->filePath("bad.csv"),
            "id,x1,y1,x2,y2,n,sigma,observations,mean_x,mean_y,xx,xy,yy\n0,1,nan,2,2,5,0.1,1,0,0,0,0,0\n");
        const Error error = failure("map.load", {{"path", "bad.csv"}});
        VERIFY_CONTAINS(error.message, "bad.csv:2");
        QVERIFY(call("map.get")["size"].toInt() > 0); // the old map stays
        QCOMPARE(::mkfifo(QFile::encodeName(folder->filePath("pipe")).constData(), 0600), 0); // nobody writes
        for (const char *path : {"none.csv", "/dev/zero", ".", "pipe"})
            QVERIFY2(failure("map.load", {{"path", path}}).is(ErrorCode::InputOutput), path);
    }

    void localizationLeavesTheMapAlone() {
        call("pose.set", {{"x", -1.5}, {"y", -0.5}, {"theta", 0.0}});
        drive(0, 10);
        const int revision = call("map.get")["revision"].toInt();
        call("matcher.start", {{"mode", "localization"}});
        QTRY_VERIFY(source->hasSubscribers("scan2d"));
        drive(10, 20);
        QCOMPARE(call("map.get")["revision"].toInt(), revision);
        QCOMPARE(call("matcher.state")["matched"].toInt(), 20);
        for (const QJsonValue &edge : call("map.get")["edges"].toArray())
            QVERIFY(edge.toObject()["observations"].toInt() <= 10);
    }

    void refusedScansAreCountedAndShown() {
        source->publish("scan2d", QJsonObject{{"stamp", 1}, {"x", QJsonArray{1}}, {"y", QJsonArray()}}, 1);
        source->publish("scan2d", "nonsense", 1);
        QTRY_COMPARE(call("matcher.state")["refused"].toInt(), 2);
        QCOMPARE(healthItem("source")["level"].toString(), QString("warn"));
        drive(0, 3); // and goes on
        QTRY_COMPARE(healthItem("source")["level"].toString(), QString("warn"));
        source->publish("scan2d", roomScan(onTheWay(3), 300), 3e11); // milliseconds
        drive(3, 4);
        QTRY_VERIFY(healthItem("source")["message"].toString().contains("1 messages could not be read"));
    }

    void aWrongSourceIsNamed() {
        drive(0, 3);
        const auto message = [this] { return healthItem("source")["message"].toString(); };
        call("settings.set", {{"values", QJsonObject{{"source", QJsonObject{{"topic", "scn2d"}}}}}});
        TRY_CONTAINS(message(), "no topic \"scn2d\"");
        QCOMPARE(healthItem("source")["level"].toString(), QString("error"));
        call("settings.set", {{"values", QJsonObject{{"source", QJsonObject{{"topic", "scan2d"}}}}}});
        TRY_STARTS(message(), "no scan from"); // after some seconds
        QCOMPARE(healthItem("source")["level"].toString(), QString("warn"));
        drive(3, 6);
        QCOMPARE(healthItem("source")["level"].toString(), QString("ok"));
    }

    void lossOfTheSourceIsShownAndMended() {
        drive(0, 3);
        const quint16 port = sourcePort;
        source->shutDown();
        source.reset();
        QTRY_COMPARE(healthItem("source")["level"].toString(), QString("error"));
        QVERIFY(healthItem("source")["message"].toString().contains(QString::number(port)));
        startSource(port);
        QTRY_VERIFY(source->hasSubscribers("scan2d"));
        drive(3, 6);
        QCOMPARE(healthItem("source")["level"].toString(), QString("ok"));
    }

    void matchesTwoScans() {
        QJsonObject reference = roomScan({0, 0, 0}, 0), current = roomScan({0.4, -0.3, 0.2}, 0);
        const QJsonObject match = call("matcher.match", {{"reference", reference}, {"current", current}});
        QVERIFY(match["accepted"].toBool());
        QVERIFY(std::abs(match["x"].toDouble() - 0.4) < 0.01 && std::abs(match["y"].toDouble() + 0.3) < 0.01);
        QVERIFY(std::abs(match["theta"].toDouble() - 0.2) < 0.005);
        QVERIFY(match["reliability"].toDouble() > 0.9);
        current["y"] = QJsonArray{1};
        const Error error = failure("matcher.match", {{"reference", reference}, {"current", current}});
        QVERIFY(error.is(ErrorCode::InvalidParams));
        VERIFY_STARTS(error.message, "current:");
    }

    void anglesBeyondATurnAreRefused() {
        const QJsonObject scan = roomScan({0, 0, 0}, 0), there{{"x", 0}, {"y", 0}, {"theta", 90}};
        const std::pair<const char *, QJsonObject> calls[] = {
            {"pose.set", there},
            {"matcher.match", {{"reference", scan}, {"current", scan}, {"expected", there}}},
            {"settings.set", {{"values", QJsonObject{{"sensor", QJsonObject{{"theta_rad", 90}}}}}}}};
        for (const auto &[method, params] : calls) {
            const Error error = failure(method, params);
            QVERIFY2(error.message.contains("did you mean 1.571 rad (90 degrees)?"),
                     qPrintable(method + (": " + error.message)));
        }
        call("pose.set", {{"x", 0}, {"y", 0}, {"theta", 2 * vectorlib::pi}});
    }

    void mapsAreListed() {
        QCOMPARE(call("map.list")["maps"].toArray().size(), 0);
        drive(0, 3);
        call("map.save", {{"path", "first.csv"}});
        call("map.export", {{"path", "no map.svg"}, {"format", "svg"}});
        QVERIFY(QDir(folder->path()).mkdir("below"));
        QTest::qWait(20); // it is newer
        call("map.save", {{"path", "below/second.csv"}});
        QVERIFY(QFile::link("/etc/hostname", folder->filePath("elsewhere.csv")));
        const QJsonArray maps = call("map.list")["maps"].toArray();
        QCOMPARE(maps.size(), 2);
        QCOMPARE(maps[0]["path"].toString(), QString("below/second.csv"));
        QCOMPARE(maps[1]["path"].toString(), QString("first.csv"));
        QVERIFY(maps[1]["bytes"].toInt() > 100 && maps[1]["modified"].toDouble() > 1.7e9);
        QVERIFY(!maps[1]["journal"].toBool());
        QVERIFY(call("map.load", {{"path", maps[0]["path"]}})["segments"].toInt() > 0);
    }

    // It was saved where the robot was elsewhere: what it sees now belongs on its walls, not across them.
    void aLoadedMapGrowsNoGhost() {
        call("pose.set", {{"x", -1.5}, {"y", -0.5}, {"theta", 0.0}});
        drive(0, 40);
        call("map.save", {{"path", "room.csv"}});
        const int walls = call("map.get")["size"].toInt();
        QCOMPARE(walls, 6);
        call("map.clear");
        drive(0, 3); // from a place of its own
        call("map.load", {{"path", "room.csv"}});
        drive(0, 1);
        for (int i = 1; i < 30; ++i)
            source->publish("scan2d", roomScan(onTheWay(30 + i), 0.1 * (30 + i)), 0.1 * (30 + i));
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), 30);
        QCOMPARE(call("map.get")["size"].toInt(), walls);
    }

    void mapTopicBeginsWithTheFullMap() {
        drive(0, 5);
        QVector<QJsonObject> updates;
        client_->subscribe("map", {{"queue", 100}},
                           [&](const TopicUpdate &update) { updates.append(update.json().toObject()); });
        QTRY_COMPARE(updates.size(), 1);
        QVERIFY(updates[0]["cleared"].toBool());
        QCOMPARE(updates[0]["edges"].toArray().size(), updates[0]["size"].toInt());
        drive(5, 6);
        QTRY_COMPARE(updates.size(), 2);
        QCOMPARE(updates[1]["revision"].toInt(), updates[0]["revision"].toInt() + 1);
        QVERIFY(!updates[1]["cleared"].toBool());
    }

    // Along a corridor without an end nothing tells how far it is.
    void healthFollowsTheTrust() {
        QJsonArray x, y;
        for (int i = 0; i < 400; ++i) {
            x << (i < 200 ? -4 + 0.04 * i : 4 - 0.04 * (i - 200));
            y << (i < 200 ? -1.0 : 1.0);
        }
        const auto show = [&](int from, int to, double ahead = 0) {
            for (int i = from; i < to; ++i)
                source->publish("scan2d",
                                QJsonObject{{"stamp", ahead + 0.1 * i}, {"turn", i}, {"x", x}, {"y", y}},
                                ahead + 0.1 * i);
            QTRY_COMPARE(call("matcher.state")["scans"].toInt(), to);
        };
        show(0, 29);        // 2.8 s
        show(29, 30, 3600); // the clock was set
        QVERIFY(!healthItem("tracking")["message"].toString().contains("doubtful"));
        show(30, 42, 3600);
        const QString message = healthItem("tracking")["message"].toString();
        VERIFY_STARTS(message, "the pose is doubtful for 4 s: its trust is 0.");
        QCOMPARE(healthItem("tracking")["level"].toString(), QString("warn"));
        call("map.clear");
        drive(0, 40);
        QCOMPARE(healthItem("tracking")["message"].toString(), QString("on track"));
    }

    void queueDropsItsOldestAndCounts() {
        std::promise<void> release;
        std::vector<quint64> seen;
        {
            Worker worker([&](const Scan &scan) { seen.push_back(scan.number); });
            worker.setQueueLimit(3);
            worker.post([&] { release.get_future().wait(); });
            for (quint64 i = 0; i < 10; ++i) {
                Scan scan;
                scan.number = i;
                worker.push(scan);
            }
            QCOMPARE(worker.dropped(), quint64(7));
            QCOMPARE(worker.waiting(), size_t(3));
            release.set_value();
        } // finishes what waits
        QCOMPARE(seen, (std::vector<quint64>{7, 8, 9}));
    }
};
