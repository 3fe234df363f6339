#include "tests/experiments/ExperimentFiles.h"

#include <QSet>

// hermes-vector experiment: those of the overview paper.
class TestOverview : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void badOdometryIsCorrected() { // overview figure 2
        QTemporaryDir folder;
        QCOMPARE(runExperiment({"overview-steps", "--runs", "2", "--out", folder.path()}), 0);
        const auto rows = table(folder.filePath("overview-steps.csv"));
        QCOMPARE(rows.size(), 2 * 10);
        QVERIFY(rows[9]["odometry_error_m"].toDouble() > 1);
        for (const auto &row : rows) {
            QCOMPARE(row["matched"], QByteArray("1"));
            QVERIFY2(row["error_m"].toDouble() < 0.01, row["error_m"].constData());
            QVERIFY2(row["error_deg"].toDouble() < 0.2, row["error_deg"].constData());
        }
        for (const char *picture : {"raw", "scan", "map"})
            QCOMPARE(lines(folder.filePath(QString("overview-steps-%1.svg").arg(picture))).last(),
                     QByteArray("</svg>"));
    }

    void corridorLoopCloses() { // overview figure 4: 46.71 m, 6 mm
        QTemporaryDir folder;
        QCOMPARE(runExperiment({"overview-loop", "--runs", "5", "--out", folder.path()}), 0);
        const auto rows = table(folder.filePath("overview-loop.csv"));
        QCOMPARE(rows.size(), 5 * 33);
        double way = 0;
        for (int i = 1; i < 33; ++i)
            way += std::hypot(rows[i]["x"].toDouble() - rows[i - 1]["x"].toDouble(),
                              rows[i]["y"].toDouble() - rows[i - 1]["y"].toDouble());
        QVERIFY2(std::abs(way - 46.71) < 0.001, saying(way));
        for (int last = 32; last < rows.size(); last += 33)
            QVERIFY2(rows[last]["error_m"].toDouble() < 0.006, rows[last]["error_m"].constData());
    }

    void ourMatchersReachFarther() { // overview 2.2 against ours
        QTemporaryDir folder;
        QCOMPARE(runExperiment({"baseline", "--runs", "1", "--out", folder.path()}), 0);
        QMap<QByteArray, double> right, tries; // by matcher
        for (const auto &row : table(folder.filePath("baseline.csv"))) {
            right[row["matcher"]] += row["right"].toDouble();
            tries[row["matcher"]] += row["tries"].toDouble();
            if (row["matcher"] == "tracker" && row["off_m"] == "0.05")
                QVERIFY2(row["right_share"].toDouble() > 0.95, row["set"] + ' ' + row["right_share"]);
        }
        QCOMPARE(right.size(), 4);
        QCOMPARE(tries["quadrangle"], 7.0 * (9 + 32 + 38)); // sizes of the error, pairs of scans
        QVERIFY(right["quadrangle"] > 0.2 * tries["quadrangle"]);
        QVERIFY(right["quadrangle"] < right["tracker"]);
        QVERIFY(right["tracker"] < right["pair matcher"]);
    }

    void baselineTakesLogs() {
        QTemporaryDir folder;
        QCOMPARE(runExperiment(
                     {"baseline", "--log", TEST_DATA_DIR "/vector/corrected.log", "--out", folder.path()}),
                 0);
        const auto rows = table(folder.filePath("baseline.csv"));
        QCOMPARE(rows.size(), 7 * 4);
        QCOMPARE(rows[0]["set"], QByteArray("corrected"));
        QVERIFY(rows[0]["tries"].toInt() > 0);
    }

    void namesOfLogsHarmNothing() {
        QTemporaryDir folder;
        const QString hostile = folder.filePath("a'; set print 'pwned'; print 1.log"),
                      out = folder.filePath("out");
        QVERIFY(QFile::copy(TEST_DATA_DIR "/vector/corrected.log", hostile));
        QCOMPARE(runExperiment({"baseline", "--log", hostile, "--out", out}), 0);
        QVERIFY(!QFile::exists("pwned") && !QFile::exists(out + "/pwned"));
        QCOMPARE(table(out + "/baseline.csv")[0]["set"], QByteArray("a---set-print--pwned---print-1"));
    }

    void logsOfOneNameAreRefused() {
        QTemporaryDir folder;
        for (const char *name : {"a", "b"}) {
            QDir(folder.path()).mkdir(name);
            for (const char *log : {"/2024.01.05.log", "/2024.01.06.log"})
                QVERIFY(QFile::copy(TEST_DATA_DIR "/vector/corrected.log", folder.path() + '/' + name + log));
        }
        const QString a = folder.filePath("a/2024.01.05.log"), b = folder.filePath("b/2024.01.05.log"),
                      other = folder.filePath("a/2024.01.06.log"), out = folder.filePath("out");
        QByteArray error;
        QCOMPARE(runExperiment({"baseline", "--log", a, "--log", b, "--out", out}, &error), 1);
        VERIFY_CONTAINS(error, "expected logs of different names");
        QVERIFY(!QFile::exists(out));
        QCOMPARE(runExperiment({"baseline", "--log", a, "--log", other, "--first", "2", "--out", out}), 0);
        QSet<QByteArray> sets;
        for (const auto &row : table(out + "/baseline.csv"))
            sets.insert(row["set"]);
        QCOMPARE(sets, (QSet<QByteArray>{"2024.01.05", "2024.01.06"}));
    }

    void figuresOfNothingAreRefused() {
        QTemporaryDir folder;
        const QString log = TEST_DATA_DIR "/vector/corrected.log", out = folder.filePath("out");
        for (const char *name : {"baseline", "pairs", "calibration"}) {
            QByteArray error;
            QCOMPARE(runExperiment({name, "--log", log, "--every", "100000", "--out", out}, &error), 1);
            VERIFY_CONTAINS(error, "no pair");
            QVERIFY(!QFile::exists(out));
        }
        // Of a log of one scan there are no errors, and no plots of them.
        QFile all(log), one(folder.filePath("one.log"));
        QVERIFY(all.open(QIODevice::ReadOnly) && one.open(QIODevice::WriteOnly));
        for (QByteArray line = all.readLine(); !line.isEmpty(); line = all.readLine()) {
            one.write(line);
            if (line.startsWith("FLASER"))
                break;
        }
        one.close();
        QCOMPARE(runExperiment({"free-log", "--log", one.fileName(), "--out", out}), 0);
        QVERIFY(lines(out + "/free-log.json").contains("  \"mean_error_m\": null,"));
        QVERIFY(QFile::exists(out + "/free-log-ways.svg") &&
                !QFile::exists(out + "/free-log-translation.svg"));
    }
};
