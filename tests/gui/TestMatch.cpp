#include "tests/gui/VectorProgram.h"

/// hermes-vector match: scans of a room from two places, as points, as segments and against a map.
class TestMatch : public QObject, protected TestFolder {
    Q_OBJECT

private Q_SLOTS:
    void init() { empty(); }

    void findsTheMotion_data() {
        const Rows<QStringList, bool, bool, double, QString> row("options", "staticPoints", "dynamicPoints",
                                                                 "most", "method");
        const QString global = "global", finder = "finder", tracking = "tracking", relations = "relations";
        const QStringList byRelations{"--method", "relations"};
        const QStringList byFinder{"--method", "finder"}, expected{"--expected", "0.6,-0.2,0.45"};
        row("points", QStringList(), true, true, 0.02, global);
        row("segments", QStringList(), false, false, 1e-9, global);
        row("points on segments", QStringList(), false, true, 0.02, global);
        row("segments on points", QStringList(), true, false, 0.02, global);
        row("points, finder", byFinder, true, true, 0.02, finder);
        row("segments, finder", byFinder, false, false, 1e-9, finder);
        row("points on segments, finder", byFinder, false, true, 0.02, finder);
        row("segments on points, finder", byFinder, true, false, 0.02, finder);
        row("points, relations", byRelations, true, true, 0.02, relations);
        row("segments, relations", byRelations, false, false, 1e-9, relations);
        row("points on segments, relations", byRelations, false, true, 0.02, relations);
        row("options of the search", {"--max-dx", "1"}, true, true, 0.02, finder);
        row("points, expected", expected, true, true, 0.02, tracking);
        row("segments, expected", expected, false, false, 1e-9, finder);
    }

    void findsTheMotion() {
        FETCH(QStringList, options, bool, staticPoints, bool, dynamicPoints, double, most, QString, method);
        const Result r = ran(QStringList{"match", seen("a.csv", "0,0,0", staticPoints),
                                         seen("b.csv", "0.7,-0.3,0.5", dynamicPoints)} +
                             options);
        QCOMPARE(r.err, QByteArray());
        const QJsonObject result = json(r.out), best = result["solutions"].toArray()[0].toObject();
        QCOMPARE(result["method"].toString(), method);
        QCOMPARE(result["outcome"].toString(), QString("found"));
        QCOMPARE(result["text"].toString(), QString("found"));
        QVERIFY(best["score"].toDouble() > 0.7 && best["score"].toDouble() <= 1);
        if (method == "global" || method == "tracking")
            QVERIFY(best["probability"].toDouble() > 0.85 && best["probability"].toDouble() <= 1);
        QVERIFY(best["accepted"].toBool());
        QCOMPARE(best["verdict"].toString(), QString("accepted"));
        const QJsonObject pose = best["pose"].toObject();
        QVERIFY(std::abs(pose["x"].toDouble() - 0.7) < most);
        QVERIFY(std::abs(pose["y"].toDouble() + 0.3) < most);
        QVERIFY(std::abs(pose["alpha"].toDouble() - 0.5) < most);
        QVERIFY(best["reliability"].toDouble() > 0.5);
        QVERIFY(best["matched_share"].toDouble() > 0.9);
        QVERIFY(best["discrepancy"].toDouble() < 0.2);
        QVERIFY(best["ambiguity"].toDouble() < 0.0025);
        const QJsonArray rows = best["covariance"].toArray();
        QCOMPARE(rows.size(), 3);
        for (int i = 0; i < 3; ++i) {
            const double sigma = std::sqrt(rows[i].toArray()[i].toDouble());
            QVERIFY(sigma > 1e-5 && sigma < 0.01);
        }
        // Segments made of points are told, since the pairs refer to them.
        QCOMPARE(result.contains("static"), staticPoints);
        QCOMPARE(result.contains("dynamic"), dynamicPoints);
        for (const QJsonValue &pair : best["pairs"].toArray())
            if (staticPoints)
                QVERIFY(pair.toArray()[0].toInt() < result["static"].toArray().size());
    }

    void pointsMayComeInAnyOrder_data() {
        const Rows<bool, QStringList> row("isShuffled", "options");
        for (const char *method : {"global", "finder", "relations"}) {
            QTest::addRow("clockwise, %s", method) << false << QStringList{"--method", method};
            QTest::addRow("shuffled, %s", method) << true << QStringList{"--method", method};
        }
        row("shuffled, expected", true, {"--expected", "0.1,0,0"});
    }

    void pointsMayComeInAnyOrder() {
        FETCH(bool, isShuffled, QStringList, options);
        const QString a = seen("a.csv", "0,0,0", true), b = seen("b.csv", "0.2,0.1,0.1", true);
        QList<QByteArray> rows = contentOf(a).trimmed().split('\n').mid(1);
        std::mt19937 random(1);
        if (isShuffled)
            std::shuffle(rows.begin(), rows.end(), random);
        else
            std::reverse(rows.begin(), rows.end());
        put(path("other.csv"), rows.join('\n') + '\n');
        const auto poseOf = [&](const QString &fixed) {
            const QJsonObject found = json(run(QStringList{"match", fixed, b} + options).out);
            return found["outcome"].toString() == "found"
                       ? found["solutions"].toArray()[0].toObject()["pose"].toObject()
                       : QJsonObject();
        };
        const QJsonObject ordered = poseOf(a), other = poseOf(path("other.csv"));
        for (const char *key : {"x", "y", "alpha"})
            QVERIFY2(other.contains(key) && std::abs(other[key].toDouble() - ordered[key].toDouble()) < 0.01,
                     key);
    }

    // The second sensor stands where the first one has not looked: two walls of the room are all that it saw.
    void mapHidesNothing() {
        put(path("part.csv"), "x1,y1,x2,y2\n-2,-1.5,4,-1.5\n4,-1.5,4,1\n");
        seen("b.csv", "0.3,0.2,0.1", false);
        const auto best = [&](const QStringList &more) {
            const Result r =
                run(QStringList{"match", path("part.csv"), path("b.csv"), "--method", "finder"} + more);
            return json(r.out)["solutions"].toArray()[0].toObject();
        };
        QCOMPARE(best({})["accepted"].toBool(), false);
        QVERIFY(best({})["verdict"].toString().startsWith("too little of the static set would be seen"));
        QCOMPARE(best({"--map"})["accepted"].toBool(), true);
    }

    void mapFileIsAMap() {
        ran({"map", data("corrected.log"), "--corrected", "--out-map", path("m.csv")});
        seen("b.csv", "0.4,0.1,0.2", true); // the log is of the same room, from (0, 0) on
        const Result r = ran({"match", path("m.csv"), path("b.csv"), "--expected", "0.5,0,0"});
        const QJsonObject best = json(r.out)["solutions"].toArray()[0].toObject();
        QVERIFY2(best["accepted"].toBool(), r.out.constData());
        QVERIFY(!best["covariance"].toArray().isEmpty());
        QVERIFY(!json(r.out).contains("static"));
    }

    void expectedPoseMovesTheSearch() {
        const QString a = seen("a.csv", "-1,0,0", false), b = seen("b.csv", "1.5,0.3,1.5", false);
        const auto accepted = [&](const QStringList &more) {
            const QJsonArray solutions =
                json(run(QStringList{"match", a, b, "--method", "finder"} + more).out)["solutions"].toArray();
            return !solutions.isEmpty() && solutions[0].toObject()["accepted"].toBool();
        };
        QVERIFY(!accepted({}));
        QVERIFY(accepted({"--expected", "2.2,0.5,1.3"}));
        QVERIFY(accepted({"--max-dx", "3", "--max-dalpha", "1.6"}));
    }

    void anyMotionNeedsNoEstimate() {
        for (const bool points : {true, false}) {
            empty();
            const QString a = seen("a.csv", "-1,0,0", points), b = seen("b.csv", "1.5,0.3,2.9", points);
            const QJsonObject best = json(run({"match", a, b}).out)["solutions"].toArray()[0].toObject();
            QVERIFY(best["accepted"].toBool());
            QVERIFY(std::abs(best["pose"].toObject()["x"].toDouble() - 2.5) < 0.02);
            QVERIFY(std::abs(best["pose"].toObject()["alpha"].toDouble() - 2.9) < 0.01);
        }
    }

    void estimateTracks() {
        const QString a = seen("a.csv", "0,0,0", true), b = seen("b.csv", "0.7,-0.3,0.5", true);
        const auto accepted = [&](const QStringList &more) {
            const QJsonArray solutions =
                json(run(QStringList{"match", a, b} + more).out)["solutions"].toArray();
            return solutions.size() == 1 && solutions[0].toObject()["accepted"].toBool();
        };
        QVERIFY(accepted({"--expected", "0.6,-0.2,0.4"}));
        QVERIFY(accepted({"--expected", "0.4,0,0.2", "--deviation-xy", "0.5", "--deviation-alpha", "0.3"}));
        QVERIFY(!accepted({"--expected", "0.7,-0.3,2.5", "--deviation-alpha", "0.01"}));
    }

    void covarianceFollowsTheNoise_data() { falseAndTrue("arePoints", "segments", "points"); }

    void covarianceFollowsTheNoise() {
        QFETCH(bool, arePoints);
        const QString a = seen("a.csv", "0,0,0", arePoints), b = seen("b.csv", "0.2,0.1,0.1", arePoints);
        const auto variance = [&](const char *noise) {
            const QJsonObject r = json(run({"match", a, b, "--noise", noise}).out);
            return r["solutions"].toArray()[0].toObject()["covariance"].toArray()[0].toArray()[0].toDouble();
        };
        const double one = variance("0.01"), two = variance("0.02");
        QVERIFY(one > 0 && std::abs(two / one - 4) < 1e-3);
    }

    void pictureIsWellFormed() {
        const QString a = seen("a.csv", "0,0,0", true), b = seen("b.csv", "0.2,0.1,0.1", true);
        put(path("wall.csv"), "1,-2,1,2\n");
        for (const QString &fixed : {a, path("wall.csv")}) {
            ran({"match", fixed, b, "--svg", path("m.svg"), "--out", path("m.json"), "--force"});
            isWellFormed(contentOf(path("m.svg")));
            QVERIFY(contentOf(path("m.svg")).contains("static set"));
        }
    }

    void wrongUse_data() {
        const Rows<QStringList, QByteArray> row("arguments", "named");
        const QString room = data("room.csv");
        row("nothing", {}, "STATIC");
        row("one scan", {room}, "DYNAMIC");
        row("half a pose", {room, room, "--expected", "1,2"}, "--expected");
        row("NaN", {room, room, "--max-dx", "nan"}, "--max-dx");
        row("no noise", {room, room, "--noise", "0"}, "--noise");
        row("deviation of nothing", {room, room, "--deviation-xy", "1"}, "--expected");
        row("no such method", {room, room, "--method", "best"}, "--method");
        row("global with an estimate", {room, room, "--method", "global", "--expected", "0,0,0"}, "--method");
        row("global with the options of another", {room, room, "--method", "global", "--max-dx", "1"},
            "--method");
        row("relations in a map", {room, room, "--method", "relations", "--map"}, "--m");
        row("points are no map", {room, room, "--map"}, "--map");
    }

    void wrongUse() {
        FETCH(QStringList, arguments, QByteArray, named);
        const Result r = run(QStringList{"match"} + arguments);
        refused(r, 2, named);
        QCOMPARE(r.out, QByteArray());
    }

    void badInput_data() {
        const Rows<QByteArray, QByteArray> row("text", "message");
        row("empty", QByteArray(), "in.csv: found an empty file");
        row("word point", "x,y\n1,two\n", "in.csv:2:");
        row("NaN segment", "1,2,3,nan\n", "in.csv:1:");
        row("three columns", "1,2,3\n", "in.csv:1:");
        row("map without sums", "id,x1,y1,x2,y2,mean_x\n0,1,2,3,4,5\n", "in.csv:1:");
        row("cut short", "x1,y1,x2,y2\n1,2,3,4\n1,2,3", "in.csv:3:");
    }

    void badInput() {
        FETCH(QByteArray, text, QByteArray, message);
        put(path("in.csv"), text);
        for (const QStringList &pair :
             {QStringList{path("in.csv"), data("room.csv")}, QStringList{data("room.csv"), path("in.csv")}}) {
            refused(run(QStringList{"match", "--out", path("out")} + pair), 1, message);
            QCOMPARE(files(), QStringList{"in.csv"});
        }
    }
};
