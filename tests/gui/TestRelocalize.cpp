#include "tests/gui/VectorProgram.h"

/// hermes-vector relocalize: the place of a scan in a map, its picture, and a scan out of a log.
class TestRelocalize : public QObject, protected TestFolder {
    Q_OBJECT

    /// Two rooms of the same shape as a map.
    QString twins() const {
        QByteArray walls = "x1,y1,x2,y2\n";
        const double corners[][2] = {{0, 0}, {4, 0}, {4, 3}, {2.5, 3}, {2.5, 2}, {0, 2}};
        for (const double x : {0.0, 10.0})
            for (int i = 0; i < 6; ++i) {
                const auto &a = corners[i], &b = corners[(i + 1) % 6];
                walls += QString("%1,%2,%3,%4\n").arg(a[0] + x).arg(a[1]).arg(b[0] + x).arg(b[1]).toUtf8();
            }
        put(path("twins.csv"), walls);
        return path("twins.csv");
    }

private Q_SLOTS:
    void init() { empty(); }

    void needsNoExpectation() {
        seen("a.csv", "0,0,0", false);
        for (const bool points : {true, false}) {
            const QString scan = seen(points ? "b.csv" : "c.csv", "0.4,0.1,2.5", points);
            const Result r = ran({"relocalize", path("a.csv"), scan});
            const QJsonObject found = json(r.out);
            QVERIFY2(found["outcome"].toString() == "found", r.out.constData());
            const QJsonObject best = found["places"].toArray()[0].toObject(), pose = best["pose"].toObject();
            QVERIFY2(best["accepted"].toBool() && best["probability"].toDouble() > 0.9, r.out.constData());
            QVERIFY(std::hypot(pose["x"].toDouble() - 0.4, pose["y"].toDouble() - 0.1) < 0.05);
            QVERIFY(std::abs(pose["alpha"].toDouble() - 2.5) < 0.03);
            QCOMPARE(best["covariance"].toArray().size(), 3);
        }
    }

    void saysWhatIsWrong() {
        const QString b = seen("b.csv", "0.4,0.1,0.2", true);
        QCOMPARE(run({"relocalize", b, b}).status, 2); // a scan is no map
        QCOMPARE(run({"relocalize", path("none.csv"), b}).status, 1);
        put(path("wall.csv"), "x1,y1,x2,y2\n-2,-1.5,4,-1.5\n");
        const Result r = ran({"relocalize", path("wall.csv"), path("wall.csv"), "--svg", path("wall.svg")});
        QCOMPARE(json(r.out)["outcome"].toString(), QString("too_little"));
        QVERIFY(json(r.out)["text"].toString().contains("fewer than two"));
        QVERIFY(json(r.out)["places"].toArray().isEmpty());
        isWellFormed(contentOf(path("wall.svg")));
        QVERIFY(contentOf(path("wall.svg")).contains("Not found"));
        QVERIFY(!contentOf(path("wall.svg")).contains("scan and sensor"));
    }

    void pictureShowsThePlace() {
        seen("a.csv", "0,0,0", false);
        for (const bool points : {true, false}) {
            const QString scan = seen("b.csv", "0.4,0.1,2.5", points);
            ran({"relocalize", path("a.csv"), scan, "--svg", path("p.svg"), "--force"});
            const QByteArray svg = contentOf(path("p.svg"));
            isWellFormed(svg);
            QVERIFY2(svg.contains(">Found<") && svg.contains(">map<"), svg.left(500).constData());
            QVERIFY(svg.contains("probable at 0.4"));
            QCOMPARE(svg.count("<circle"), 2); // the sensor in the map and in the legend
            QFile::remove(path("b.csv"));
        }
        QCOMPARE(run({"relocalize", path("a.csv"), path("a.csv"), "--svg", path("p.svg")}).status,
                 1); // exists
    }

    void pictureNumbersPlacesThatAreAlike() {
        put(path("w.json"), "{\"name\": \"room\", \"edges\": [[0,0,4,0],[4,0,4,3],[4,3,2.5,3],[2.5,3,2.5,2],"
                            "[2.5,2,0,2],[0,2,0,0]]}");
        ran({"observe", path("w.json"), "--pose", "2.8,1,0.4", "--scan", "720", "--noise", "0.01", "--out",
             path("s.csv")});
        const Result r = run({"relocalize", twins(), path("s.csv"), "--svg", path("p.svg")});
        QVERIFY2(json(r.out)["outcome"].toString() == "ambiguous", r.out.constData());
        const QByteArray svg = contentOf(path("p.svg"));
        isWellFormed(svg);
        QVERIFY(svg.contains(">1: scan and sensor") && svg.contains(">2: scan and sensor"));
        QCOMPARE(svg.count("<circle"), 4);
        QVERIFY(svg.contains("Not found: 2 places in the map fit alike"));
    }

    void logIsNoScan_data() { rowsOf("command", {"relocalize", "match"}); }
    /// What the message says to do does it.
    void logIsNoScan() {
        QFETCH(QString, command);
        const QString map = seen("a.csv", "0,0,0", false), log = data("corrected.log");
        writeCapture(path("c.pcap"), 10);
        for (const QString &file : {log, path("c.pcap")}) {
            const Result r = run({command, map, file});
            QCOMPARE(r.status, 1);
            const QByteArray advice = "hermes-vector map " + file.toUtf8() + " --scan N --out scan.csv";
            QVERIFY2(r.err.contains(advice), r.err.constData());
        }
        ran({"map", log, "--scan", "0", "--out", path("scan.csv")});
        const QByteArray name = command == "match" ? "solutions" : "places";
        QCOMPARE(run({"segment", log}).status, 1);
        const QJsonObject best =
            json(run({command, map, path("scan.csv")}).out)[QString(name)].toArray()[0].toObject();
        QVERIFY(std::abs(best["pose"].toObject()["x"].toDouble()) < 0.05);
    }

    void scanOfALog() {
        const QString log = data("corrected.log");
        const Result first = run({"map", log, "--scan", "0"}), second = run({"map", log, "--scan", "1"});
        QCOMPARE(first.status, 0);
        QVERIFY(first.out.startsWith("x,y\n"));
        QVERIFY(first.out.count('\n') > 150 && first.out.count('\n') < 183); // 181 rays, some without return
        QVERIFY(first.out != second.out);
        refused(run({"map", log, "--scan", "1000", "--out", path("scan.csv")}), 1,
                "expected a scan 1000 (they count from 0)");
        QVERIFY(files().isEmpty());
        const Result map = run({"map", log, "--scan", "1", "--out-map", path("m.csv")});
        QCOMPARE(map.status, 2);
        QVERIFY2(map.err.contains("--scan") && map.err.contains("--out-map"), map.err.constData());
    }
    void scanOfACapture() {
        writeCapture(path("c.pcap"), 600); // over three turns, a wall at 5 m
        const Result r = ran({"map", path("c.pcap"), "--scan", "1"});
        const QList<QByteArray> rows = r.out.trimmed().split('\n').mid(1);
        QVERIFY(rows.size() > 1000);
        for (const QByteArray &row : rows) {
            const QList<QByteArray> xy = row.split(',');
            QVERIFY2(std::abs(std::hypot(xy[0].toDouble(), xy[1].toDouble()) - 5) < 0.1, row.constData());
        }
    }
};
