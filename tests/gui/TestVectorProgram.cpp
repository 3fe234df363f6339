#include "tests/gui/VectorProgram.h"

/// hermes-vector as its users meet it: columns, values, files, help.
class TestVectorProgram : public QObject, protected TestFolder {
    Q_OBJECT

private Q_SLOTS:
    void init() { empty(); }

    void columns_data() {
        const Rows<QStringList, QByteArray, int> row("arguments", "header", "rows");
        row("segment", {"segment", data("room.csv")}, "index,cluster", 360);
        row("vectorize tls", {"vectorize", data("room.csv"), "--algorithm", "tls", "--no-segment"},
            "cluster,first,last,a,b,c,sigma,x1,y1,x2,y2", 1);
        row("observe", {"observe", data("world.json"), "--pose", "-1,0.5,1.5"}, "x1,y1,x2,y2", 6);
        row("observe a scan",
            {"observe", data("world.json"), "--pose=0,0,0", "--scan", "100", "--noise", "0.01", "--outliers",
             "0.1", "--seed", "3", "--fov", "180"},
            "x,y", 100);
    }
    void columns() {
        FETCH(QStringList, arguments, QByteArray, header, int, rows);
        const Result r = ran(arguments);
        QCOMPARE(r.err, QByteArray());
        const QList<QByteArray> lines = r.out.trimmed().split('\n');
        QCOMPARE(lines.first(), header);
        QCOMPARE(lines.size() - 1, rows);
    }

    void vectorizeFindsTheWalls_data() {
        rowsOf("algorithm", {"ftls", "aftls", "inc", "dp", "rw", "rw-adjacent", "sam"});
    }
    void vectorizeFindsTheWalls() {
        QFETCH(QString, algorithm);
        const Result r = ran({"vectorize", data("room.csv"), "--no-segment", "--algorithm", algorithm});
        int next = 0;
        for (const QByteArray &line : r.out.trimmed().split('\n').mid(1)) {
            const QList<QByteArray> f = line.split(',');
            QCOMPARE(f.size(), 11);
            QCOMPARE(f[0], QByteArray("0"));
            QCOMPARE(f[1].toInt(), next); // every point belongs to one line
            next = f[2].toInt() + 1;
            QVERIFY(f[5].toDouble() >= 0); // c
            if (algorithm == "ftls" || algorithm == "inc")
                QVERIFY(f[6].toDouble() <= 0.02 + 1e-9); // sigma
            QVERIFY(std::abs(std::hypot(f[3].toDouble(), f[4].toDouble()) - 1) < 1e-9);
        }
        QCOMPARE(next, 360);
    }

    void registerTellsThePose_data() {
        const Rows<QStringList> row("options");
        row("default", {});
        row("wahba, length", {"--rotation", "wahba", "--weights", "length"});
        row("column", {"--weights", "column", "--k-alpha", "2", "--k-xy", "0.5"});
    }
    void registerTellsThePose() {
        QFETCH(QStringList, options);
        const Result r = ran(QStringList{"register", data("pairs.csv")} + options);
        const QJsonObject pose = json(r.out);
        QCOMPARE(pose.keys(), (QStringList{"alpha", "ambiguity", "ambiguity_alpha", "ambiguity_xy", "pairs",
                                           "reliability", "x", "y"}));
        QVERIFY(std::abs(pose["x"].toDouble() - 1) < 1e-9);
        QVERIFY(std::abs(pose["y"].toDouble() + 2) < 1e-9);
        QVERIFY(std::abs(pose["alpha"].toDouble() - 0.3) < 1e-9);
        QCOMPARE(pose["pairs"].toInt(), 6);
    }
    /// Far from the origin an error of rotation must not turn into one of translation (erratum 13): the
    /// middle of the segments stays where it is although the angles do not agree.
    void similarityOfSeveralMotions() {
        const Result r = run({"similarity", "--pose", "0,0,0", data("pairs.csv"), "--pose", "1,-2,0.3"});
        QCOMPARE(r.err, QByteArray());
        const QList<QByteArray> rows = r.out.trimmed().split('\n');
        QCOMPARE(rows.size(), 3);
        QCOMPARE(rows[0], QByteArray("x,y,alpha,criterion"));
        QVERIFY(rows[1].startsWith("0,0,0,") && rows[1].split(',')[3].toDouble() > 1);
        QVERIFY(rows[2].startsWith("1,-2,0.3,") && rows[2].split(',')[3].toDouble() < 1e-9);
    }
    void similarityFarFromTheOrigin() { // the same pair with its origins 1,000 km away
        const Result near = run({"similarity", "-", "--pose", "0,0.01,0"}, "0,0,1,0,0,0,1,0\n"),
                     far = run({"similarity", "-", "--pose", "0,0.01,0"},
                               "1e6,1e6,1000001,1e6,1e6,1e6,1000001,1e6\n");
        const auto criterion = [](const Result &r) { return r.out.trimmed().split(',').last().toDouble(); };
        QVERIFY(std::abs(criterion(near) - 4e-4) < 1e-12); // (2 x 1 m x 1 cm)^2
        QVERIFY(std::abs(criterion(far) - 4e-4) < 1e-9);
    }
    void registerFarFromTheOrigin() {
        const Result r = ran({"register", "-"},
                             "100000,0,100001,0.01,100000,0,100001,0\n100000,0,100000,1,100000,0,100000,1\n");
        const QJsonObject p = json(r.out);
        const double a = p["alpha"].toDouble(), x = 100000.5, y = 0.25;
        QVERIFY(a > 0.001);
        QVERIFY(std::abs(std::cos(a) * x - std::sin(a) * y + p["x"].toDouble() - x) < 0.02);
        QVERIFY(std::abs(std::sin(a) * x + std::cos(a) * y + p["y"].toDouble() - y) < 0.02);
    }

    void mapWritesEveryKind() {
        const Result r = ran({"map", data("corrected.log"), "--corrected", "--out-map", path("m.csv"),
                              "--out-trajectory", path("t.tum"), "--out-graph", path("g.g2o"), "--summary",
                              path("s.json"), "--svg", path("p.svg"), "--out-trust", path("t.csv")});
        QCOMPARE(r.err, QByteArray());
        QCOMPARE(r.out, QByteArray());
        QCOMPARE(files(), (QStringList{"g.g2o", "m.csv", "p.svg", "s.json", "t.csv", "t.tum"}));
        QVERIFY(contentOf(path("m.csv")).startsWith("id,x1,y1,x2,y2,n,sigma,observations,"));
        QVERIFY(contentOf(path("p.svg")).startsWith("<svg"));
        QCOMPARE(contentOf(path("g.g2o")).count("VERTEX_SE2 "), 2); // key scans
        QCOMPARE(contentOf(path("g.g2o")).count("EDGE_SE2 "), 1);
        const QJsonObject s = json(contentOf(path("s.json")));
        for (const char *key : {"scans", "skipped", "matched", "lost", "closures", "closures_tried",
                                "closures_refused", "closures_seconds", "review", "parallel_twins",
                                "ms_per_scan", "segments", "map_bytes", "seconds"})
            QVERIFY2(s.contains(QLatin1String(key)), key);
        QCOMPARE(s["ms_per_scan"].toObject().keys(), (QStringList{"map", "match", "segment", "vectorize"}));
        QCOMPARE(s["review"].toObject().keys(),
                 (QStringList{"contradicted_m", "corners", "cut", "joined", "merged", "removed", "seconds"}));
        QCOMPARE(s["parallel_twins"].toObject().keys(), (QStringList{"m", "of_m", "real_m", "share"}));
        QVERIFY(s["parallel_twins"].toObject()["of_m"].toDouble() > 1);
        QCOMPARE(s["parallel_twins"].toObject()["share"].toDouble(), 0.0);
        QCOMPARE(s["scans"].toInt(), 8);
        QCOMPARE(s["matched"].toInt(), 8);
        QCOMPARE(s["map_bytes"].toInt(), contentOf(path("m.csv")).size());
        QCOMPARE(s["reference"].toObject()["within_10cm_2deg"].toDouble(), 1.0);
        const QList<QByteArray> poses = contentOf(path("t.tum")).trimmed().split('\n');
        QCOMPARE(poses.size(), 8);
        QCOMPARE(poses[7].split(' ').size(), 8);
        QCOMPARE(poses[7].split(' ')[0].toDouble(), 7.0);
        QVERIFY(std::abs(poses[7].split(' ')[1].toDouble() - 1.05) < 0.05);
        const QList<QByteArray> trust = contentOf(path("t.csv")).trimmed().split('\n');
        QCOMPARE(trust.size(), 9);
        QCOMPARE(trust[0], QByteArray("stamp,trust"));
        QCOMPARE(trust[8].split(',')[0].toDouble(), 7.0);
        QVERIFY(trust[8].split(',')[1].toDouble() > 0.5 && trust[8].split(',')[1].toDouble() <= 1);
        QVERIFY(s["trust"].toObject()["mean"].toDouble() > 0.5);
        QCOMPARE(s["trust"].toObject()["percentile_5"].toDouble(), 0.0); // of the first, which had no map

        for (const char *name : {"m.svg", "m.geojson", "m.dxf", "m.pgm"})
            ran({"map", data("raw.log"), "--out-map", path(name), "--odometry", "ignore", "--every", "2"});
        QVERIFY(files().contains("m.yaml"));
        QVERIFY(contentOf(path("m.yaml")).contains("image: m.pgm"));
    }

    /// As logs have them that were rounded, or put together in another order than measured.
    void trajectoriesAscendWhereTheLogDoesNot() {
        const QList<QByteArray> stamps{"0", "1", "1", "1", "4", "2", "3", "7"};
        QList<QByteArray> lines = contentOf(data("corrected.log")).split('\n');
        int scan = 0;
        for (QByteArray &line : lines) {
            QList<QByteArray> fields = line.simplified().split(' ');
            if (fields[0] != "FLASER")
                continue;
            fields[fields.size() - 3] = stamps[scan++];
            line = fields.join(' ');
        }
        QCOMPARE(scan, stamps.size());
        put(path("in.log"), lines.join('\n'));
        const Result r = ran({"map", path("in.log"), "--corrected", "--out-trajectory", path("t.tum")});
        QList<QByteArray> written;
        for (const QByteArray &line : contentOf(path("t.tum")).trimmed().split('\n'))
            written << line.split(' ')[0];
        QCOMPARE(written,
                 (QList<QByteArray>{"0", "1", "1.000001", "1.000002", "4", "4.000001", "4.000002", "7"}));
        const QJsonObject mended = json(r.out)["moved_stamps"].toObject();
        QCOMPARE(mended["stamps"].toInt(), 4);
        QCOMPARE(mended["ties"].toInt(), 2);
        QCOMPARE(mended["steps_back"].toInt(), 1);
        QVERIFY(std::abs(mended["farthest_s"].toDouble() - 2.000001) < 1e-9);
        QVERIFY2(r.err.contains("moved 4 stamp(s)") && r.err.contains("2 tie(s)") &&
                     r.err.contains("1 step(s) back"),
                 r.err.constData());
        // Nothing is said of what was moved where nothing was written.
        QVERIFY(!run({"map", path("in.log"), "--corrected"}).err.contains("moved"));
    }

    /// Of the public logs one steps back, two lost the digits of their stamps.
    void trajectoriesOfRealLogsAscend_data() {
        const Rows<int, int> row("ties", "stepsBack");
        row("intel", 0, 4);
        row("belgioioso", 394, 0);
        row("orebro", 236, 0);
    }
    void trajectoriesOfRealLogsAscend() {
        REAL_DATA(log, QString("%1-corrected.log.gz").arg(QTest::currentDataTag()));
        const Result r = ran({"map", log, "--corrected", "--out-trajectory", path("t.tum")});
        double last = -INFINITY;
        for (const QByteArray &line : contentOf(path("t.tum")).trimmed().split('\n')) {
            QVERIFY(line.split(' ')[0].toDouble() > last);
            last = line.split(' ')[0].toDouble();
        }
        const QJsonObject mended = json(r.out)["moved_stamps"].toObject();
        QTEST(mended["ties"].toInt(), "ties");
        QTEST(mended["steps_back"].toInt(), "stepsBack");
    }

    void mapOfAFolder() {
        QVERIFY(QDir(path("")).mkpath("scans"));
        for (int i = 0; i < 3; ++i)
            ran({"observe", data("world.json"), "--pose", QStringLiteral("0.%1,0,0").arg(i), "--scan", "400",
                 "--out", path(qPrintable(QStringLiteral("scans/%1.csv").arg(i))), "--force"});
        const Result r = ran({"map", path("scans"), "--out-trajectory", path("t.tum")});
        QCOMPARE(json(r.out)["matched"].toInt(), 3);
        QVERIFY(std::abs(contentOf(path("t.tum")).split('\n')[2].split(' ')[1].toDouble() - 0.2) < 0.01);
    }

    void ring() {
        writeCapture(path("c.pcap"), 400); // 400 * 12 * 0.17 degrees: two turns and a quarter
        const Result r = ran({"ring", path("c.pcap")});
        QCOMPARE(r.err, QByteArray());
        const QList<QByteArray> lines = r.out.trimmed().split('\n');
        QCOMPARE(lines[0], QByteArray("turn,stamp,azimuth,range,intensity,x,y"));
        QCOMPARE(lines.size() - 1, 4800);
        const QList<QByteArray> last = lines.last().split(',');
        QCOMPARE(last[0], QByteArray("2"));
        QCOMPARE(last[3].toDouble(), 5.0);
        const double azimuth = last[2].toDouble() * M_PI / 180;
        QVERIFY(std::abs(last[5].toDouble() - 5 * std::cos(azimuth)) < 1e-6); // x forward
        QVERIFY(std::abs(last[6].toDouble() + 5 * std::sin(azimuth)) <
                1e-6); // y left, the azimuth runs clockwise

        const Result one = run({"ring", path("c.pcap"), "--turn", "1", "--all"});
        QVERIFY(one.out.startsWith("turn,stamp,laser,azimuth,range,intensity,x,y,z\n1,"));
        const Result laser = run({"ring", path("c.pcap"), "--laser", "0", "--turn", "1"});
        QCOMPARE(one.out.count('\n') - 1, 32 * (laser.out.count('\n') - 1));
        QCOMPARE(run({"ring", path("c.pcap"), "--turn", "3"}).status, 1);
        const Result map = ran({"map", path("c.pcap")});
        QCOMPARE(json(map.out)["scans"].toInt(), 3);
    }

    void compressedAndStandardInput() {
        const QByteArray plain = run({"segment", data("room.csv")}).out;
        QCOMPARE(run({"segment", "-"}, contentOf(data("room.csv"))).out, plain);
        QProcess gzip;
        gzip.setStandardInputFile(data("room.csv"));
        gzip.start("gzip", {"-c"});
        QVERIFY(gzip.waitForFinished());
        const QByteArray compressed = gzip.readAllStandardOutput();
        put(path("room.csv.gz"), compressed);
        QCOMPARE(run({"segment", path("room.csv.gz")}).out, plain);
        put(path("cut.gz"), compressed.left(compressed.size() - 20));
        refused(run({"segment", path("cut.gz")}), 1, "breaks off");
    }

    void helpAndVersion() {
        QCOMPARE(run({"--version"}).out.left(14), QByteArray("hermes-vector "));
        for (const char *command :
             {"segment", "vectorize", "register", "similarity", "match", "observe", "map", "ring"}) {
            const Result r = ran({command, "--help"});
            QVERIFY2(r.out.contains(QByteArray("Example:\n  hermes-vector ") + command), r.out.constData());
        }
    }

    void realLogs_data() {
        const Rows<QString> row("name");
        for (const char *name : {"intel", "fhw", "belgioioso", "orebro", "freiburg-079"})
            row(name, QString::fromLatin1(name) + "-corrected.log.gz");
    }
    void realLogs() {
        QFETCH(QString, name);
        REAL_DATA(log, name);
        const Result r = ran({"map", log, "--corrected", "--every", "2", "--out-map", path("m.csv")});
        QVERIFY(json(r.out)["scans"].toInt() > 100);
        QVERIFY(contentOf(path("m.csv")).count('\n') > 100);
    }

    void realCapture() {
        REAL_DATA(capture, "hdl32e-outdoor.pcap");
        const Result r = ran({"ring", capture});
        QVERIFY(r.out.count('\n') > 2000);
    }

    void realPacketOfAVlp16() {
        REAL_DATA(capture, "vlp16-single-packet.pcap");
        const Result all = ran({"ring", capture, "--all"});
        QCOMPARE(all.out.count('\n'), 261);
        refused(run({"ring", capture, "--laser", "16"}), 1, "found a VLP-16, expected a laser from 0 to 15");
        QCOMPARE(run({"ring", capture, "--model", "hdl32e"}).status, 1);
    }
};
