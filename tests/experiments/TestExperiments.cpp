#include "tests/experiments/ExperimentFiles.h"
#include "vectorlib/experiments/RelationScans.h"
#include "vectorlib/experiments/Scene.h"

using namespace hermes;
using namespace hermes::experiments;

// hermes-vector experiment: its scenes, its measure of error, the files that it leaves.
class TestExperiments : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void scenesShowWhatTheirFiguresShow() {
        QCOMPARE(solitaryEdges().visible().size(), std::size_t(4));
        QCOMPARE(sharpCorners().visible().size(), std::size_t(5));
        QCOMPARE(furnishedRoom().visible().size(), std::size_t(15));
    }

    void errorAreaOfAKnownShift() {
        using Segment = vectorlib::LineSegment2D<float>;
        const std::vector<Segment> truth{Segment({2, -2}, {2, 2})},
            shifted{Segment({2.1f, -2.1f}, {2.1f, 2.1f})};
        QVERIFY(errorArea(truth, truth) < 1e-12);
        // Between two similar triangles of 4.00 and 4.41 m^2.
        QVERIFY(std::abs(errorArea(truth, shifted) - 0.41) < 0.001);
        QCOMPARE(errorArea(truth, {}), 0.0);
    }

    void writesTablePlotsAndDocument() {
        QTemporaryDir folder;
        QCOMPARE(run({"corners", "--runs", "2", "--max-points", "500", "--out", folder.filePath("new")}), 0);
        const auto rows = lines(folder.filePath("new/corners.csv"));
        QCOMPARE(rows.value(0),
                 QByteArray("sigma,points,algorithm,runs,lines_true,lines_found,lines_percent,lines_low,"
                            "lines_high,area_m2,area_low_m2,area_high_m2,time_us"));
        QVERIFY(rows.size() >= 3);
        QVERIFY(rows.value(1).startsWith("0.02,200,"));
        QVERIFY(lines(folder.filePath("new/corners.tex")).last() == "\\end{document}");
        QVERIFY(lines(folder.filePath("new/corners-figures.json")).last().startsWith("{\"plots\":[{"));
        QCOMPARE(error_.contains("matplotlib is not installed"), !hasMatplotlib());
        if (!hasMatplotlib())
            QSKIP("matplotlib is not installed");
        for (const char *plot : {"time", "lines", "area"}) {
            QVERIFY(lines(folder.filePath(QString("new/corners-%1.svg").arg(plot))).last() == "</svg>");
            QVERIFY(lines(folder.filePath(QString("new/corners-%1.pdf").arg(plot))).last() == "%%EOF");
        }
    }

    void sameSeedGivesTheSameLines() {
        QTemporaryDir folder;
        QVector<QList<QByteArray>> found;
        for (const char *name : {"a", "b"}) {
            QCOMPARE(run({"room", "--runs", "2", "--max-points", "500", "--seed", "7", "--out",
                          folder.filePath(name)}),
                     0);
            found.append(lines(folder.filePath(QString(name) + "/room.csv")));
            for (QByteArray &row : found.last())
                row.truncate(row.lastIndexOf(',')); // all but the time
        }
        QCOMPARE(found[0], found[1]);
    }

    void segmentationLeavesNinePanels() {
        QTemporaryDir folder;
        QCOMPARE(run({"segmentation-room", "--out", folder.path()}), 0);
        QCOMPARE(QDir(folder.path()).entryList({"*.svg"}).size(), 9);
        const auto rows = lines(folder.filePath("segmentation-room.csv"));
        QCOMPARE(rows.size(), 10);
        const QList<QByteArray> clean = rows[1].split(','); // 1 cm of noise, no outliers
        QCOMPARE(clean[4], clean[3]);                       // all clusters, none broken
    }

    void polygonsAreMeasuredByVertices() {
        QTemporaryDir folder;
        QCOMPARE(run({"polygons", "--runs", "2", "--out", folder.path()}), 0);
        const auto rows = lines(folder.filePath("polygons.csv"));
        QCOMPARE(rows.value(0),
                 QByteArray("vertices_true,budget,algorithm,scans,sigma,vertices,rmse,hit_share,area_error"));
        QCOMPARE(rows.size(), 1 + 6 * 7 * 7); // kinds of polygons and all, J, algorithms
        for (const QByteArray &row : rows.mid(1)) {
            const QList<QByteArray> fields = row.split(',');
            if (fields[0] != "6" || fields[1] != "10" || fields[2] != "AFTLS")
                continue;
            QVERIFY2(fields[5].toDouble() <= 10 && fields[6].toDouble() < 0.05, row.constData());
            QVERIFY2(fields[7].toDouble() > 0.97 && fields[8].toDouble() < 0.01, row.constData());
        }
        QCOMPARE(run({"log", "--out", folder.path(), "--force"}), 2);
    }

    // Thesis figures 7.16 to 7.20: five bundles in one bucket, three in the other, 15 combinations.
    void accuracyKeepsPotentialPairsFew() {
        QTemporaryDir folder;
        const QString base = folder.filePath("potential-pairs");
        QCOMPARE(run({"potential-pairs", "--runs", "1", "--out", folder.path()}), 0);
        const auto text = [&](const QString &name) { return lines(base + name).join('\n'); };
        QVERIFY(text("-bucket-1.svg").contains("bucket 1 of 2 with 5 bundles; 15 combinations in all"));
        QVERIFY(text("-bucket-2.svg").contains("bucket 2 of 2 with 3 bundles; 15 combinations in all"));
        for (const char *name : {"-scans.svg", "-pairs-30cm.svg", "-pairs-70cm.svg", "-pairs-120cm.svg",
                                 "-expected-view.svg", "-correct.svg", "-wrong.svg"})
            QVERIFY2(text(name).endsWith("</svg>") && !text(name).contains("nan"), name);
        QVERIFY(text("-figures.tex").contains("Figure 7.20") &&
                text("-figures.tex").endsWith("\\end{document}"));
        QMap<QByteArray, QVector<double>> pairs;
        for (const auto &row : table(base + ".csv")) {
            pairs[row["scene"]].append(row["potential_pairs"].toDouble());
            QVERIFY(row["true_pairs"].toDouble() <= row["potential_pairs"].toDouble());
            if (row["accuracy_m"] == "0.05" &&
                row["scene"] != "quadratic") // whose first steps are 1, 4 and 9 cm
                QCOMPARE(row["true_pairs"], row["potential_pairs"]);
        }
        QCOMPARE(pairs.size(), 3);
        for (const QVector<double> &curve : pairs) {
            QCOMPARE(curve.size(), 12);
            QVERIFY(curve.last() > 2.5 * curve.first());
        }
    }

    void wahbaIsMildWithLargeErrors() { // paper figure 10
        QTemporaryDir folder;
        QCOMPARE(run({"rotation", "--runs", "40", "--out", folder.path()}), 0);
        const auto rows = table(folder.filePath("rotation.csv"));
        QCOMPARE(rows.size(), 36);
        for (const auto &row : rows) {
            const double noise = row["noise_rad"].toDouble(), mitsuta = row["mitsuta_rad"].toDouble(),
                         wahba = row["wahba_rad"].toDouble();
            QVERIFY(std::abs(mitsuta / noise * 3 * std::sqrt(3) - 1) < 0.1); // a third of a uniform turn
            if (noise < 0.5)
                QVERIFY(std::abs(wahba / mitsuta - 1) < 0.05);
            if (noise > 2.5)
                QVERIFY(wahba < 0.95 * mitsuta);
        }
    }

    void posesThatAreEqualAreNoWay() {
        World world;
        world.poses = {{1, 2, 0.3}, {1, 2, 0.3}};
        QCOMPARE(posesAlong(world, 4).size(), std::size_t(4));
        for (const auto &pose : posesAlong(world, 4))
            QVERIFY(pose.x == 1 && pose.y == 2 && std::abs(pose.theta - 0.3) < 1e-9);
        world.poses.push_back({3, 2, 0});
        const auto poses = posesAlong(world, 3);
        QVERIFY(poses[0].x == 1 && poses[0].y == 2 && poses[1].x > 1.5 && poses[1].x < 2.5);
        QVERIFY(std::abs(poses[2].x - 3) < 1e-6);
    }

    void leapsThroughAHomeAreMatched() {
        QTemporaryDir folder;
        QCOMPARE(run({"free-leaps", "--out", folder.path()}), 0);
        const auto rows = table(folder.filePath("free-leaps.csv"));
        QCOMPARE(rows.size(), 23);
        double metres = 0, degrees = 0;
        for (const auto &row : rows.mid(1)) {
            QVERIFY2(row["matched"] == "1", row["scan"].constData());
            metres += row["error_m"].toDouble() / 22;
            degrees += row["error_deg"].toDouble() / 22;
        }
        QVERIFY(metres < 0.02 && degrees < 0.5);
        QVERIFY(lines(folder.filePath("free-leaps.tex")).last() == "\\end{document}");
        QVERIFY(lines(folder.filePath("free-leaps.json")).join().contains("\"lost\": 0"));
    }

    void errorAreaGrowsWithTheError() {
        QTemporaryDir folder;
        QCOMPARE(run({"free-copy", "--out", folder.path()}), 0);
        QMap<QByteArray, double> last;
        for (const auto &row : table(folder.filePath("free-copy.csv"))) {
            const double area = row["error_area_m2"].toDouble();
            if (row["amount"].toDouble() == 0)
                QVERIFY(area < 1e-9);
            else
                QVERIFY2(area > last[row["kind"]], row["amount"].constData());
            last[row["kind"]] = area;
        }
        QCOMPARE(last.size(), 2);
    }

    void errorAreaDoesNotGrowWithTheWay() {
        QTemporaryDir folder;
        QCOMPARE(run({"free-approach", "--every", "40", "--out", folder.path()}), 0);
        double area[2] = {0, 0}, pairs[2] = {0, 0}; // up to 5 m and beyond 10 m
        for (const auto &row : table(folder.filePath("free-approach.csv"))) {
            const double distance = row["distance_m"].toDouble(), count = row["pairs"].toDouble();
            if (row["pairs_of"] != "first" || (distance > 5 && distance < 10))
                continue;
            area[distance > 5] += count * row["error_area_m2"].toDouble();
            pairs[distance > 5] += count;
        }
        QVERIFY(pairs[0] > 300 && pairs[1] > 500);
        QVERIFY(area[1] / pairs[1] < 1.5 * area[0] / pairs[0]);
    }

    void missingWorldIsNamed() {
        QTemporaryDir folder;
        QCOMPARE(run({"accuracy", "--worlds", folder.path(), "--out", folder.filePath("new")}), 1);
        QVERIFY2(error_.contains("cutsquare.json") && error_.contains("--worlds"), error_);
        QVERIFY(QDir(folder.filePath("new")).entryList(QDir::Files).isEmpty());
    }

    void realScansAreShown() {
        QTemporaryDir folder;
        const QString log = QStringLiteral(TEST_DATA_DIR "/vector/corrected.log");
        for (const char *name : {"empty-room", "corridor", "laboratory"}) {
            QVERIFY2(run({name, "--log", log, "--out", folder.path()}) == 0, error_);
            const auto rows = lines(folder.filePath(QString("%1.csv").arg(name)));
            QCOMPARE(rows.value(0), QByteArray("scan,points,clusters,lines_reference,algorithm,lines,"
                                               "lines_percent,time_us,time_percent"));
            QCOMPARE(rows.size(), 7); // algorithms
            for (const QByteArray &row : rows.mid(1))
                QVERIFY2(row.split(',')[5].toInt() > 0, row);
            QVERIFY(lines(folder.filePath(QString("%1.svg").arg(name))).last() == "</svg>");
            QCOMPARE(run({name, "--out", folder.path(), "--force"}), 2);
        }
        QFile empty(folder.filePath("empty.log"));
        QVERIFY(empty.open(QIODevice::WriteOnly));
        empty.close();
        QCOMPARE(run({"corridor", "--log", empty.fileName(), "--out", folder.filePath("none")}), 1);
    }

    void refusesToOverwrite() {
        QTemporaryDir folder;
        QFile file(folder.filePath("corners.csv"));
        QVERIFY(file.open(QIODevice::WriteOnly));
        file.close();
        QCOMPARE(run({"corners", "--runs", "1", "--max-points", "200", "--out", folder.path()}), 1);
        QVERIFY(error_.contains("corners.csv"));
        QCOMPARE(QDir(folder.path()).entryList(QDir::Files), QStringList("corners.csv"));
    }

    void unknownExperimentIsAUsageError() {
        QCOMPARE(run({"nonsense"}), 2);
        QVERIFY(error_.contains("semicircle"));
    }

private:
    int run(const QStringList &arguments) { return runExperiment(arguments, &error_); }
    QByteArray error_;
};
