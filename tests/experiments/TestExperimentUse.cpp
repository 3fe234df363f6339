#include "tests/gui/VectorProgram.h"

/// hermes-vector experiment as a program: which options it takes, what it prints, what a failure leaves.
class TestExperimentUse : public QObject {
    Q_OBJECT

    QTemporaryDir folder_;

    QString path(const char *name) const { return folder_.filePath(QLatin1String(name)); }
    static QString log() { return data("corrected.log"); }
    static QByteArray firstLine(const QString &file) { return contentOf(file).split('\n').first(); }

private Q_SLOTS:
    void initTestCase() { QVERIFY(folder_.isValid()); }

    void refusesOptionsItDoesNotUse_data() {
        Rows<QStringList, QByteArray, QByteArray>("arguments", "option", "taker");
        const auto row = [](const QStringList &arguments, const char *option, const char *taker) {
            QTest::newRow(qPrintable(arguments.join(' ')))
                << arguments << QByteArray(option) << QByteArray(taker);
        };
        row({"corners", "--half", "1"}, "--half", "pairs, calibration");
        row({"corners", "--no-guess"}, "--no-guess", "pairs");
        row({"corners", "--every", "5"}, "--every", "free-approach");
        row({"semicircle", "--seed", "5"}, "--seed", "corners");
        row({"rotation", "--worlds", "."}, "--worlds", "accuracy");
        row({"criterion", "--runs", "5"}, "--runs", "polygons");
        row({"free-leaps", "--log", log()}, "--log", "free-log");
        row({"places", "--log", log(), "--max-points", "100"}, "--max-points", "semicircle");
        row({"calibration", "--log", log(), "--draw", "3"}, "--draw", "pairs");
        row({"pairs", "--log", log(), "--other", log()}, "--other", "places");
        row({"free-log", "--log", log(), "--first", "3"}, "--first", "pairs");
        row({"pairs", "--log", log(), "--every", "1", "--every", "2"}, "--every", "one for each --log");
    }
    void refusesOptionsItDoesNotUse() {
        FETCH(QStringList, arguments, QByteArray, option, QByteArray, taker);
        const Result r = run(QStringList{"experiment"} + arguments + QStringList{"--out", path("refused")});
        QCOMPARE(r.status, 2);
        QVERIFY2(r.err.contains(option) && r.err.contains(taker), r.err.constData());
        QVERIFY(!QFileInfo::exists(path("refused")));
    }
    void halvesAreTwo() {
        const Result r = run({"experiment", "pairs", "--half", "3"});
        QCOMPARE(r.status, 2);
        QVERIFY2(r.err.startsWith("hermes-experiments: --half: 3 not in {1,2}"), r.err.constData());
    }

    /// hermes-vector starts the program beside it, else that of the search path, and says so where there is
    /// none.
    void isFoundByTheOtherProgram() {
        const QString bin = qEnvironmentVariable("HERMES_BIN"), alone = path("hermes-vector");
        QVERIFY(QFile::copy(bin + "/hermes-vector", alone));
        QProcess process;
        const auto helpOf = [&](const QString &program, const QString &searched, const char *command) {
            QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
            environment.insert("PATH", searched);
            process.setProcessEnvironment(environment);
            process.start(program, {QLatin1String(command), "--help"});
            return process.waitForFinished(60000) ? process.readAllStandardOutput() : QByteArray();
        };
        for (const char *command : {"experiment", "report"}) {
            const QByteArray help = helpOf(bin + "/hermes-experiments", "/nowhere", command);
            QVERIFY2(help.contains(QByteArray("Example:\n  hermes-experiments ") + command),
                     help.constData());
            QCOMPARE(helpOf(bin + "/hermes-vector", "/nowhere", command), help);
            QCOMPARE(helpOf(alone, bin, command), help);
            QCOMPARE(helpOf(alone, "/nowhere", command), QByteArray());
            QCOMPARE(process.exitCode(), 1);
            const QByteArray error = process.readAllStandardError();
            QVERIFY2(error.contains("hermes-experiments, which is not installed"), error.constData());
        }
    }

    void failureLeavesNoFolder() {
        refused(run({"experiment", "accuracy", "--worlds", folder_.path(), "--out", path("a/b/c")}), 1,
                "cutsquare.json");
        QVERIFY(!QFileInfo::exists(path("a")));
        QVERIFY(QDir(folder_.path()).mkdir("there"));
        QCOMPARE(run({"experiment", "log", "--out", path("there")}).status, 2);
        QVERIFY(QFileInfo::exists(path("there"))); // it was there before
    }
    void interruptLeavesNoFolder() {
        QProcess process;
        process.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-experiments",
                      {"experiment", "dispersion", "--runs", "10000", "--out", path("new/results")});
        QTRY_VERIFY_WITH_TIMEOUT(QFileInfo::exists(path("new/results")), 30000);
        process.terminate();
        QVERIFY(process.waitForFinished(30000));
        QVERIFY(process.exitStatus() == QProcess::CrashExit);
        QVERIFY(!QFileInfo::exists(path("new")));
    }
    void folderThatIsAFileIsRefused() {
        put(path("file"), "precious");
        refused(run({"experiment", "criterion", "--out", path("file/folder")}), 1,
                "file/folder: cannot be made");
        QCOMPARE(contentOf(path("file")), QByteArray("precious"));
    }

    // What is published is of one log, which nobody else has.
    void anyLogHasNoPublishedFigures() {
        const Result r = ran({"experiment", "free-log", "--log", log(), "--out", path("free-log")});
        QVERIFY(json(r.out)["scans"].toInt() > 1);
        QVERIFY2(!r.out.contains("published"), r.out.constData());
        const Result home = run({"experiment", "free-leaps", "--out", path("free-leaps")});
        QCOMPARE(json(home.out)["published"].toObject()["length_m"].toDouble(), 43.19);
    }

    void copyPrintsASummary() {
        const Result r = ran({"experiment", "free-copy", "--out", path("free-copy")});
        QVERIFY2(json(r.out)["area_at_10_deg_m2"].toDouble() > 1, r.out.constData());
        QVERIFY(json(r.out)["area_at_50_cm_m2"].toDouble() > 1);
        QVERIFY(json(r.out)["grows_throughout"].toBool());
        QCOMPARE(contentOf(path("free-copy/free-copy.json")), r.out);
    }

    // There is no right place in another building, and so no error.
    void scansOfAnotherBuildingHaveNoErrors() {
        ran({"experiment", "places", "--log", log(), "--out", path("own")});
        QCOMPARE(firstLine(path("own/places.csv")),
                 QByteArray("scan,found,right,places,score,probability,error_m,error_deg,time_ms"));
        const Result r =
            ran({"experiment", "places", "--log", log(), "--other", log(), "--out", path("other")});
        QCOMPARE(firstLine(path("other/places.csv")),
                 QByteArray("scan,accepted,places,score,probability,time_ms"));
        for (const QByteArray &row : contentOf(path("other/places.csv")).trimmed().split('\n'))
            QCOMPARE(row.count(','), 5);
        QVERIFY(!json(r.out).contains("first_right"));
        QVERIFY(json(r.out).contains("found_wrong"));
    }

    void drawnPlacesNeedNoLog() {
        const Result r = ran({"experiment", "drawn-places", "--runs", "1", "--out", path("drawn")});
        QCOMPARE(json(r.out)["sets"].toObject()["home"].toObject()["scans"].toInt(), 50);
        QVERIFY(json(r.out)["slope_of_time"].toDouble() > 0);
        QCOMPARE(contentOf(path("drawn/drawn-places.json")), r.out);
        QVERIFY(firstLine(path("drawn/drawn-places.csv")).startsWith("set,has_place,outcome,"));
    }
    void trustIsFittedToLogsAndDrawnBuildings() {
        const Result r = ran({"experiment", "place-trust", "--log", log(), "--log", log(), "--other", log(),
                              "--runs", "1", "--out", path("trust")});
        for (const char *weights : {"present", "fitted"}) {
            const QJsonObject of = json(r.out)[QLatin1String(weights)].toObject();
            QVERIFY(of["weights"].toObject()["rival"].toDouble() > 0);
            QCOMPARE(of["second_half"].toObject()["tenths"].toArray().size(), 10);
        }
        for (const char *set :
             {"\"logs\"", "\"logs, map with drift\"", "\"logs, other building\"", "\"worlds\""})
            QVERIFY2(contentOf(path("trust/place-trust.csv")).contains(set), set);
    }
    void trustOfPosesIsFittedToOneHalf() {
        QVERIFY(QFile::copy(log(), path("copy.log")));
        const Result r = ran({"experiment", "pose-trust", "--log", log(), "--other", log(), "--other",
                              path("copy.log"), "--runs", "4", "--out", path("poses")});
        for (const char *weights : {"present", "fitted"}) {
            const QJsonObject of = json(r.out)[QLatin1String(weights)].toObject();
            QCOMPARE(of["weights"].toArray().size(), 6);
            for (const char *part : {"first half", "second half", "never fitted"}) {
                const QJsonObject result = of[QLatin1String(part)].toObject();
                QCOMPARE(result["tenths"].toArray().size(), 10);
                QVERIFY2(result["poses"].toInt() > 0, part);
            }
        }
        QVERIFY(contentOf(path("poses/pose-trust.csv")).contains("\"drawn "));
        QCOMPARE(run({"experiment", "places", "--log", log(), "--other", log(), "--other", log(), "--out",
                      path("two")})
                     .status,
                 2);
    }
};
