// hermes-vector experiment pairs on real logs: how often the motion between two scans is found.
class TestScanPairs : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void sharesOnRealLogs_data() {
        const Rows<QString, QStringList, int, double> row("log", "options", "pairs", "share");
        const QStringList alone{"--no-guess"};
        row("intel", "intel", {}, 909, 0.97);
        row("freiburg-079", "freiburg-079", {"--first", "1000"}, 1000, 0.995);
        row("freiburg-079, every 5th", "freiburg-079", {"--every", "5"}, 958, 0.95);
        row("fhw", "fhw", {}, 487, 0.90);
        row("belgioioso", "belgioioso", {}, 394, 0.99);
        row("orebro, no odometry", "orebro", {}, 236, 0.75);
        row("intel, no guess", "intel", alone, 909, 0.965);
        row("freiburg-079, every 5th, no guess", "freiburg-079", alone + QStringList{"--every", "5"}, 958,
            0.948);
        row("fhw, no guess", "fhw", alone, 487, 0.90);
        row("belgioioso, no guess", "belgioioso", alone, 394, 0.99);
        row("orebro, no guess", "orebro", alone, 236, 0.97);
    }

    void sharesOnRealLogs() {
        FETCH(QString, log, QStringList, options, int, pairs, double, share);
        REAL_DATA(path, log + "-corrected.log.gz");
        QCOMPARE(run(QStringList{"--log", path} + options), 0);
        const QJsonObject found = QJsonDocument::fromJson(output_).object();
        const bool isGuessed = !options.contains("--no-guess");
        QCOMPARE(found["pairs"].toInt(), pairs);
        QVERIFY2(found["within_10cm_2deg"].toDouble() >= share, output_.constData());
        QVERIFY2(isGuessed || found["accepted_of_right"].toDouble() >= 0.9, output_.constData());
        QVERIFY2(found["accepted_wrong"].toDouble() < (isGuessed ? 0.01 : 0.003), output_.constData());
    }

    void halvesMakeTheWhole() {
        REAL_DATA(path, "belgioioso-corrected.log.gz");
        double right = 0;
        int pairs = 0;
        for (const QStringList &half :
             {QStringList{"--half", "1"}, QStringList{"--half", "2"}, QStringList{}}) {
            QCOMPARE(run(QStringList{"--log", path, "--no-guess"} + half), 0);
            const QJsonObject found = QJsonDocument::fromJson(output_).object();
            const int sign = half.isEmpty() ? -1 : 1;
            pairs += sign * found["pairs"].toInt();
            right += sign * found["pairs"].toInt() * found["within_10cm_2deg"].toDouble();
        }
        QCOMPARE(pairs, 0);
        QVERIFY(std::abs(right) < 1e-6);
    }

    // On the half of the pairs that the probability was not fitted to.
    void probabilitiesAreCalibrated() {
        QStringList arguments{"--half", "2", "--every", "1", "--every", "5", "--every", "1"};
        for (const char *log : {"intel", "freiburg-079", "fhw", "belgioioso", "orebro"}) {
            REAL_DATA(path, QLatin1String(log) + "-corrected.log.gz");
            arguments += {"--log", path};
        }
        QCOMPARE(run(arguments, "calibration"), 0);
        const QJsonObject found = QJsonDocument::fromJson(output_).object();
        for (const char *of : {"best", "all"})
            for (const QJsonValue &tenth : found[of].toArray())
                if (tenth["solutions"].toInt() >= 50)
                    QVERIFY2(std::abs(tenth["told"].toDouble() - tenth["right"].toDouble()) < 0.03,
                             output_.constData());
        QVERIFY(QFile::exists(folder_.filePath("out/calibration.csv")));
        QVERIFY(QFile::exists(folder_.filePath("out/calibration.tex")));
    }

    void writesARowAPairAndPictures() {
        // A sensor that turns by 5 degrees a step before a corner of two walls. The last scan sees nothing.
        QFile log(folder_.filePath("corner.log"));
        QVERIFY(log.open(QIODevice::WriteOnly));
        for (int scan = 0; scan < 4; ++scan) {
            const double heading = scan * 5 * 3.14159265358979 / 180;
            QByteArray ranges;
            for (int i = 0; i < 180; ++i) {
                const double angle = heading + (i - 90) * 3.14159265358979 / 180;
                const double x = std::cos(angle) > 0.05 ? 3 / std::cos(angle) : 60;
                const double y = std::sin(angle) < -0.05 ? -2 / std::sin(angle) : 60;
                ranges += QByteArray::number(scan < 3 ? std::min(x, y) : 81.91, 'f', 3) + ' ';
            }
            const QByteArray pose = "0 0 " + QByteArray::number(heading, 'f', 6) + ' ';
            const QByteArray wheels =
                "ODOM 0 0 " + QByteArray::number(heading + 0.05, 'f', 6) + " 0 0 0 1 h 1\n";
            log.write("FLASER 180 " + ranges + pose + pose + "1 h " + QByteArray::number(scan) + '\n' +
                      wheels);
        }
        log.close();
        QCOMPARE(run({"--log", log.fileName(), "--draw", "5"}), 0);
        const QJsonObject found = QJsonDocument::fromJson(output_).object();
        QCOMPARE(found["pairs"].toInt(), 3);
        QVERIFY2(std::abs(found["within_10cm_2deg"].toDouble() - 2.0 / 3) < 1e-6, output_.constData());
        QVERIFY2(std::abs(found["accepted"].toDouble() - 2.0 / 3) < 1e-6, output_.constData());
        QCOMPARE(found["accepted_wrong"].toDouble(), 0.0);
        const QList<QByteArray> rows = contentOf(folder_.filePath("out/pairs.csv")).trimmed().split('\n');
        QCOMPARE(rows.size(), 4);
        QVERIFY(rows[0].startsWith("from,to,error_m,error_deg,"));
        QVERIFY(rows[3].startsWith("2,3,"));
        QVERIFY(QFile::exists(folder_.filePath("out/pairs-2.svg")));
        QVERIFY(!QFile::exists(folder_.filePath("out/pairs-0.svg")));
        // Without odometry it is all the same; two walls and a corner are enough.
        QCOMPARE(run({"--log", log.fileName(), "--draw", "5", "--no-guess"}), 0);
        QVERIFY2(std::abs(QJsonDocument::fromJson(output_).object()["within_10cm_2deg"].toDouble() -
                          2.0 / 3) < 1e-6,
                 output_.constData());
    }

    void needsALog() {
        QCOMPARE(run({}), 2);
        QCOMPARE(run({"--log", folder_.filePath("none.log")}), 1);
        QCOMPARE(run({}, "calibration"), 2);
        QCOMPARE(run({"--log", "a", "--log", "b"}), 2);
        QCOMPARE(run({"--log", "a", "--half", "3"}), 2);
    }

private:
    int run(const QStringList &arguments, const QString &experiment = "pairs") {
        QProcess process;
        process.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-experiments",
                      QStringList{"experiment", experiment, "--out", folder_.filePath("out"), "--force"} +
                          arguments);
        process.waitForFinished(120000);
        output_ = process.readAllStandardOutput();
        return process.exitStatus() == QProcess::NormalExit ? process.exitCode() : -1;
    }
    QTemporaryDir folder_;
    QByteArray output_;
};
