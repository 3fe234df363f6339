#include "MatcherFixture.h"
#include "common/world/World.h"
#include "vectorlib/io/MapCsv.h"
#include "vectorlib/observation/SimulatedScanner.h"

using namespace hermes;
using vectorlib::Pose2D;
using Segments = std::vector<vectorlib::LineSegment2D<double>>;
using Point = vectorlib::Vector2D<double>;

static Segments pillars() {
    const auto world =
        readWorld(qEnvironmentVariable("HERMES_SOURCE").toStdString() + "/deploy/worlds/pillars.json");
    Segments walls;
    if (!world)
        qWarning("%s", world.error().c_str());
    else
        for (const World::Edge &e : world->edges)
            walls.emplace_back(Point(e.x1, e.y1), Point(e.x2, e.y2));
    return walls;
}

static Segments square() {
    return {{{-3, -3}, {3, -3}}, {{3, -3}, {3, 3}}, {{3, 3}, {-3, 3}}, {{-3, 3}, {-3, -3}}};
}

// Halls side by side, each with some of the pillars, and these a little elsewhere.
static Segments building() {
    const Segments hall = pillars();
    Segments walls;
    std::mt19937 random(5);
    const auto unit = [&random] { return double(random() % 1000) / 1000; };
    for (int room = 0; room < 25; ++room)
        for (size_t i = 0; i + 4 <= hall.size(); i += 4) {
            const bool isThere = unit() < 0.7 || i == 0;
            const Point shift = i == 0 ? Point() : Point(unit() - 0.5, unit() - 0.5);
            const Point at = Point(11.0 * (room % 5), 9.0 * (room / 5)) + shift;
            for (size_t k = i; k < i + 4 && isThere; ++k)
                walls.emplace_back(hall[k].begin() + at, hall[k].end() + at);
        }
    return walls;
}

// As if every wall had a point every 2 cm.
static vectorlib::EdgeRaw2D edgeOf(const vectorlib::LineSegment2D<double> &wall) {
    std::vector<Point> points;
    for (double t = 0; t <= wall.length(); t += 0.02)
        points.push_back(wall.begin() + wall.direction() * t);
    const auto sums = vectorlib::TlsSums::of(points.begin(), points.end());
    return {sums, wall, 0.01};
}

static bool isNear(const Pose2D &a, const Pose2D &b) {
    return std::hypot(a.x - b.x, a.y - b.y) < 0.03 &&
           std::abs(vectorlib::wrapAngle(a.theta - b.theta)) < 0.02;
}

static Pose2D poseOf(const QJsonObject &pose) {
    return {pose["x"].toDouble(), pose["y"].toDouble(), pose["theta"].toDouble()};
}

Q_DECLARE_METATYPE(vectorlib::Pose2D)

class TestRelocalization : public QObject, MatcherFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        setUp();
        call("matcher.start", {{"mode", "localization"}});
        QTRY_VERIFY(source->hasSubscribers("scan2d"));
        set("relocalize_after", 0);
        scanner = vectorlib::SimulatedScanner<float>(7);
        scanner.rays = 1000;
        scans = loaded = 0;
    }

    void cleanup() { tearDown(); }

    void findsTheKidnappedRobot_data() {
        QTest::addColumn<Pose2D>("pose");
        const Pose2D poses[] = {{1, 0.9, 0},      {4.35, 0.9, 2}, {8.4, 2.1, -1.4}, {7.4, 3.7, 3},
                                {3.4, 3.6, 0.75}, {1, 6.5, -2.5}, {5.2, 4, 1.5},    {8.9, 7, -3.1}};
        for (const Pose2D &p : poses)
            QTest::addRow("%g, %g, %g", p.x, p.y, p.theta) << p;
    }

    void findsTheKidnappedRobot() {
        QFETCH(Pose2D, pose);
        load(pillars());
        call("pose.set", {{"x", 4.5}, {"y", 6.6}, {"theta", 1.0}}); // far away
        scan(pillars(), pose);
        const QJsonObject found = call("pose.relocalize");
        QVERIFY2(isNear(poseOf(found["pose"].toObject()), pose), QJsonDocument(found).toJson());
        QVERIFY(found["accepted"].toBool() && found["applied"].toBool());
        QVERIFY(found["reliability"].toDouble() > 0.5);
        QVERIFY(found["candidates"].toArray().size() >= 1);
        for (const char *member : {"ambiguity", "discrepancy", "matched_share", "score", "ms"})
            QVERIFY2(found[member].isDouble(), member);
        QJsonObject next;
        client_->subscribe("pose", {}, [&](const TopicUpdate &update) { next = update.json().toObject(); });
        QTRY_VERIFY(matcher->hasSubscribers("pose"));
        const Pose2D then{pose.x + 0.05, pose.y, pose.theta + 0.02};
        scan(pillars(), then);
        QTRY_COMPARE(next["scan"].toInt(), 2);
        QVERIFY2(isNear(poseOf(next), then), QJsonDocument(next).toJson());
        QCOMPARE(next["outcome"].toString(), QString("matched"));
        QCOMPARE(healthItem("tracking")["level"].toString(), QString("ok"));
    }

    void onlyTellsWhereItIs() {
        load(pillars());
        call("pose.set", {{"x", 4.5}, {"y", 6.6}, {"theta", 1.0}});
        scan(pillars(), {1, 0.9, 0});
        const QJsonObject found = call("pose.relocalize", {{"apply", false}});
        QVERIFY(isNear(poseOf(found["pose"].toObject()), {1, 0.9, 0}));
        QVERIFY(!found["applied"].toBool(true));
        scan(pillars(), {1, 0.9, 0});
        QCOMPARE(call("matcher.state")["lost"].toInt(), 2);
    }

    void refusesWhatFitsInSeveralPlaces() {
        load(square());
        const Pose2D truth{1, 0.5, 0.3};
        scan(square(), truth);
        const Error error = failure("pose.relocalize", {});
        QVERIFY(error.is(ErrorCode::NotReady));
        VERIFY_CONTAINS(error.message, "4 places");
        const QJsonObject data = error.data.toObject();
        QCOMPARE(data["outcome"].toString(), QString("ambiguous"));
        for (int quarter = 0; quarter < 4; ++quarter) { // the room looks the same after every quarter turn
            const Pose2D place = (vectorlib::Transformation2D(0, 0, quarter * vectorlib::pi / 2) *
                                  vectorlib::Transformation2D(truth))
                                     .pose();
            int matches = 0;
            for (const QJsonValue &c : data["candidates"].toArray())
                matches += isNear(poseOf(c.toObject()["pose"].toObject()), place);
            QCOMPARE(matches, 1);
        }
        // A person chooses.
        call("pose.set", {{"x", truth.x}, {"y", truth.y}, {"theta", truth.theta}});
        scan(square(), truth);
        QCOMPARE(healthItem("tracking")["values"].toObject()["lost_in_a_row"].toInt(), 0);
    }

    void refusesWhatFitsNowhere() {
        load(pillars());
        scan({{{-1, -2}, {5, -1}}, {{5, -1}, {2, 7}}, {{2, 7}, {-1, -2}}}, {2, 1, 0}); // three walls aslant
        const Error error = failure("pose.relocalize", {});
        QVERIFY(error.is(ErrorCode::NotReady));
        QCOMPARE(error.data.toObject()["outcome"].toString(), QString("nowhere"));
    }

    void saysThatThereIsNoScanOrMap() {
        const Error noScan = failure("pose.relocalize", {});
        QVERIFY(noScan.is(ErrorCode::NotReady));
        QCOMPARE(noScan.data.toObject()["outcome"].toString(), QString("no_scan"));
        scan(square(), {});
        const Error noMap = failure("pose.relocalize", {});
        QVERIFY(noMap.is(ErrorCode::NotReady));
        QCOMPARE(noMap.data.toObject()["outcome"].toString(), QString("no_map"));
        VERIFY_CONTAINS(noMap.message, "map is empty");
    }

    void saysThatTheScanShowsTooLittle() {
        load(pillars());
        scan({{{-2, -1}, {2, -1}}}, {});
        QCOMPARE(failure("pose.relocalize", {}).data.toObject()["outcome"].toString(), QString("too_little"));
    }

    void recoversByItselfAfterLostScans() {
        load(pillars());
        set("relocalize_after", 4);
        call("pose.set", {{"x", 4.5}, {"y", 6.6}, {"theta", 1.0}});
        for (int i = 0; i < 6; ++i)
            scan(pillars(), {1 + 0.02 * i, 0.9, 0});
        const QJsonObject state = call("matcher.state");
        QCOMPARE(state["lost"].toInt(), 4);
        QCOMPARE(state["matched"].toInt(), 2);
        QCOMPARE(state["recoveries"].toInt(), 1);
        QCOMPARE(state["recovered"].toInt(), 1);
        const auto log = client_->callAndWait("log.tail");
        QVERIFY(log.ok());
        const QByteArray text = QJsonDocument(QJsonArray{*log}).toJson();
        VERIFY_CONTAINS(text, "found in the whole map after 4 lost scans");
    }

    void aLoadedMapWaitsForItsPlace() {
        beginToMap();
        load(pillars());
        for (int i = 0; i < 12; ++i)
            scan(square(), {0.05 * i, 0.3, 0.2}); // another building
        QCOMPARE(number("map_segments"), int(pillars().size()));
        QCOMPARE(number("matched"), 0);
        QVERIFY(healthItem("tracking")["message"].toString().contains("nothing is mapped"));
        scan(pillars(), {1, 0.9, 0});
        call("pose.relocalize");
        scan(pillars(), {1, 0.9, 0}, 3);
        QCOMPARE(healthItem("tracking")["message"].toString().left(8), QString("on track"));
        QCOMPARE(number("matched"), 3);
        QCOMPARE(number("map_segments"), int(pillars().size()));
    }

    void aPlaceThatIsToldIsTried() {
        set("relocalize_after", 5);
        beginToMap();
        int doubtful = 0, sure = 0; // poses of lost scans
        client_->subscribe("pose", {}, [&](const TopicUpdate &update) {
            const QJsonObject pose = update.json().toObject();
            const bool isLost = pose["outcome"] == "lost";
            doubtful += isLost && pose["covariance"].isNull() && pose["trust"].toDouble(1) == 0;
            sure += isLost && pose["covariance"].isArray();
        });
        QTRY_VERIFY(matcher->hasSubscribers("pose"));
        load(pillars());
        QTRY_VERIFY((scan(pillars(), {1, 0.9, 0}), number("matched") > 1));
        call("pose.set", {{"x", 2}, {"y", 1.5}, {"theta", 0.3}});
        scan(pillars(), {1, 0.9, 0}, 4);
        QCOMPARE(number("map_segments"), int(pillars().size()));
        QVERIFY(healthItem("tracking")["message"].toString().contains("place that was told"));
        const int lost = number("lost");
        QVERIFY(lost > 0);
        QTRY_VERIFY((scan(pillars(), {1, 0.9, 0}), number("lost") < number("scans") - 4));
        QTRY_VERIFY(
            (scan(pillars(), {1, 0.9, 0}), !healthItem("tracking")["message"].toString().contains("told")));
        QCOMPARE(number("map_segments"), int(pillars().size()));
        call("pose.set", {{"x", 1}, {"y", 0.9}, {"theta", 0}});
        scan(pillars(), {1, 0.9, 0}, 6);
        QCOMPARE(healthItem("tracking")["message"].toString(), QString("on track"));
        QTRY_VERIFY(doubtful > 0);
        QCOMPARE(sure, 0);
    }

    void nothingIsMappedWhereScansContradictTheMap() {
        load(pillars());
        Segments hall = pillars();
        hall.resize(4); // without the pillars
        int told = 0, accepted = 0;
        client_->subscribe("scan", {}, [&](const TopicUpdate &update) {
            ++told;
            accepted += update.json().toObject()["match"].toObject()["accepted"].toBool(true);
        });
        QTRY_VERIFY(matcher->hasSubscribers("scan"));
        call("pose.set", {{"x", 5.2}, {"y", 4}, {"theta", 1.5}});
        scan(hall, {5.2, 4, 1.5}, 10);
        QCOMPARE(lost(), 10);
        QTRY_COMPARE(told, 10);
        QCOMPARE(accepted, 0);
        beginToMap();
        QTRY_VERIFY(healthItem("tracking")["message"].toString().contains("is sought"));
    }

    void anUndoneCommandDoesNotConfirmAPlaceThatWasFound() {
        beginToMap();
        load(pillars());
        for (int i = 0; i < 5 || (i < 100 && call("matcher.state")["place"].toString() == "sought"); ++i)
            scan(pillars(), {5.2, 4, 1.5});
        QCOMPARE(call("matcher.state")["place"].toString(), QString("found"));
        call("pose.set", {{"x", 1}, {"y", 1}, {"theta", 0}});
        QCOMPARE(call("matcher.state")["place"].toString(), QString("told"));
        call("map.undo");
        for (int i = 0; i < 10; ++i) // from one spot
            scan(pillars(), {5.2, 4, 1.5});
        QCOMPARE(call("matcher.state")["place"].toString(), QString("found"));
    }

    void aToldPlaceIsNoMotionOfTheDrive() {
        beginToMap();
        scan(pillars(), {1, 0.9, 0}, 5);
        QTRY_COMPARE(number("key_scans"), 1);
        call("pose.set", {{"x", 0}, {"y", 0}, {"theta", 0}}); // where it stands
        scan(pillars(), {1, 0.9, 0}, 10);
        QCOMPARE(call("matcher.state")["place"].toString(), QString("known"));
        QTRY_COMPARE(number("key_scans"), 2); // another part begins
    }

    void aPersonMayInsistOnAPlace() {
        beginToMap();
        load(pillars());
        call("pose.set", {{"x", 20}, {"y", 20}, {"theta", 0}, {"confirm", true}});
        scan(square(), {}, 5);
        QVERIFY(number("map_segments") > int(pillars().size()));
    }

    void triesSeldomWhereItCannotRecover() {
        load(square());
        set("relocalize_after", 1);
        call("pose.set", {{"x", 0}, {"y", 0}, {"theta", 0.8}});
        auto time = runningTimer();
        scan(square(), {2, -1.5, 0}, 20);
        QCOMPARE(call("matcher.state")["lost"].toInt(), 20);
        const int tried = call("matcher.state")["recoveries"].toInt();
        QVERIFY2(tried >= 1 && tried <= 1 + time.elapsed() / 1000, saying(tried));
        const QJsonObject tracking = healthItem("tracking");
        QCOMPARE(tracking["level"].toString(), QString("error"));
        VERIFY_CONTAINS(tracking["message"].toString(), "4 places");
    }

    void neverTriesWhereItIsSwitchedOff() {
        load(pillars());
        call("pose.set", {{"x", 4.5}, {"y", 6.6}, {"theta", 1.0}});
        scan(pillars(), {1, 0.9, 0}, 12);
        QCOMPARE(lost(), 12);
        QCOMPARE(call("matcher.state")["recoveries"].toInt(), 0);
    }

    void theMapMayGrowOnlyBeforeItHoldsTheScan() {
        load(pillars());
        beginToMap();
        QTRY_VERIFY(source->hasSubscribers("scan2d"));
        set("relocalize_after", 2);
        call("pose.set", {{"x", 4.5}, {"y", 6.6}, {"theta", 1.0}});
        scan(pillars(), {1, 0.9, 0}, 3);
        QCOMPARE(call("matcher.state")["matched"].toInt(), 1);
        QCOMPARE(call("matcher.state")["recovered"].toInt(), 1);
        set("relocalize_after", 3); // too late: the third lost scan is in the map
        call("pose.set", {{"x", 4.5}, {"y", 6.6}, {"theta", 1.0}});
        scan(pillars(), {1, 0.9, 0}, 3);
        QCOMPARE(call("matcher.state")["lost"].toInt(), 2 + 3);
        QCOMPARE(call("matcher.state")["recoveries"].toInt(), 1);
    }

    void largeMapTakesNoLongerThanPermitted() {
        load(building());
        qInfo("%zu edges", building().size());
        set("relocalize_s", std::min(3 * slowness, 20)); // 3 is the default, 20 the most
        scan(building(), {23.4, 21.6, 0.75});
        const QJsonObject found = call("pose.relocalize");
        QVERIFY2(isNear(poseOf(found["pose"].toObject()), {23.4, 21.6, 0.75}), QJsonDocument(found).toJson());
        qInfo("%d parts, %.0f ms", found["parts"].toInt(), found["ms"].toDouble());
        set("relocalize_s", 0.01);
        Segments town; // of which not even the index is made in that time
        for (int house = 0; house < 100; ++house)
            for (const auto &wall : building()) {
                const Point at(60.0 * (house % 10), 50.0 * (house / 10));
                town.emplace_back(wall.begin() + at, wall.end() + at);
            }
        load(town);
        scan(building(), {23.4, 21.6, 0.75});
        const Error error = failure("pose.relocalize", {});
        QCOMPARE(error.data.toObject()["outcome"].toString(), QString("unfinished"));
        QVERIFY(error.data.toObject()["searched"].toInt() < error.data.toObject()["parts"].toInt());
    }

private:
    void beginToMap() {
        call("matcher.stop");
        QTRY_VERIFY(!source->hasSubscribers("scan2d"));
        call("matcher.start", {{"mode", "mapping"}});
        QTRY_VERIFY(source->hasSubscribers("scan2d"));
    }

    void load(const Segments &walls) {
        std::vector<vectorlib::MapEdge> map;
        for (const auto &wall : walls)
            map.emplace_back(int64_t(map.size()), edgeOf(wall), 10);
        std::ofstream file(folder->filePath("map.csv").toStdString());
        vectorlib::writeMapCsv(file, map);
        file.close();
        QCOMPARE(call("map.load", {{"path", "map.csv"}})["segments"].toInt(), int(walls.size()));
        loaded = scans;
    }

    void scan(const Segments &walls, const Pose2D &pose, int times) {
        for (int i = 0; i < times; ++i)
            scan(walls, pose);
    }
    void scan(const Segments &walls, const Pose2D &pose) {
        std::vector<vectorlib::LineSegment2D<float>> world;
        for (const auto &wall : walls)
            world.emplace_back(vectorlib::Vector2D<float>(wall.begin()),
                               vectorlib::Vector2D<float>(wall.end()));
        QJsonArray x, y;
        for (const auto &point : scanner(world, pose)) {
            x.append(double(point.x));
            y.append(double(point.y));
        }
        const double stamp = 0.1 * ++scans;
        source->publish("scan2d", QJsonObject{{"stamp", stamp}, {"turn", scans}, {"x", x}, {"y", y}}, stamp);
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), scans - loaded);
    }

    void set(const QString &name, const QJsonValue &value) {
        QVERIFY(!call("settings.set", {{"values", QJsonObject{{"matcher", QJsonObject{{name, value}}}}}})
                     .contains("failed"));
    }
    int number(const char *count) { return call("matcher.state")[count].toInt(); }
    int lost() { return healthItem("tracking")["values"].toObject()["lost_in_a_row"].toInt(); }

    vectorlib::SimulatedScanner<float> scanner;
    int scans = 0, loaded = 0;
};
