#include "gui/vector/experiment/Scene.h"

#include <QProcess>
#include <QTemporaryDir>
#include <QtTest>

using namespace hermes;

// hermes-vector experiment: its scenes, its measure of error, the files that it leaves.
class TestExperiments : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void scenesShowWhatTheirFiguresShow();
    void errorAreaOfAKnownShift();
    void writesTablePlotsAndDocument();
    void sameSeedGivesTheSameLines();
    void segmentationLeavesNinePanels();
    void polygonsAreMeasuredByVertices();
    void refusesToOverwrite();
    void unknownExperimentIsAUsageError();

private:
    int run(const QStringList &arguments) {
        QProcess process;
        process.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-vector",
                      QStringList("experiment") + arguments);
        process.waitForFinished(60000);
        error_ = process.readAllStandardError();
        return process.exitStatus() == QProcess::NormalExit ? process.exitCode() : -1;
    }
    static QList<QByteArray> lines(const QString &path) {
        QFile file(path);
        return file.open(QIODevice::ReadOnly) ? file.readAll().trimmed().split('\n') : QList<QByteArray>();
    }
    QByteArray error_;
};

void TestExperiments::scenesShowWhatTheirFiguresShow() {
    QCOMPARE(solitaryEdges().visible().size(), std::size_t(4));
    QCOMPARE(sharpCorners().visible().size(), std::size_t(5));
    QCOMPARE(furnishedRoom().visible().size(), std::size_t(15));
}

void TestExperiments::errorAreaOfAKnownShift() {
    using Segment = vectorlib::LineSegment2D<float>;
    const std::vector<Segment> truth{Segment({2, -2}, {2, 2})}, shifted{Segment({2.1f, -2.1f}, {2.1f, 2.1f})};
    QVERIFY(errorArea(truth, truth) < 1e-12);
    // Between two similar triangles of 4.00 and 4.41 m^2.
    QVERIFY(std::abs(errorArea(truth, shifted) - 0.41) < 0.001);
    QCOMPARE(errorArea(truth, {}), 0.0);
}

void TestExperiments::writesTablePlotsAndDocument() {
    QTemporaryDir folder;
    QCOMPARE(run({"corners", "--runs", "2", "--max-points", "500", "--out", folder.filePath("new")}), 0);
    const auto rows = lines(folder.filePath("new/corners.csv"));
    QCOMPARE(rows.value(0),
             QByteArray("sigma,points,algorithm,runs,lines_true,lines_found,lines_percent,area_m2,time_us"));
    QVERIFY(rows.size() >= 3);
    QVERIFY(rows.value(1).startsWith("0.02,200,"));
    QVERIFY(lines(folder.filePath("new/corners.tex")).last() == "\\end{document}");
    if (error_.contains("gnuplot is not installed"))
        QSKIP("gnuplot is not installed");
    for (const char *plot : {"time", "lines", "area"})
        QVERIFY(lines(folder.filePath(QString("new/corners-%1.svg").arg(plot))).last() == "</svg>");
}

void TestExperiments::sameSeedGivesTheSameLines() {
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

void TestExperiments::segmentationLeavesNinePanels() {
    QTemporaryDir folder;
    QCOMPARE(run({"segmentation-room", "--out", folder.path()}), 0);
    QCOMPARE(QDir(folder.path()).entryList({"*.svg"}).size(), 9);
    const auto rows = lines(folder.filePath("segmentation-room.csv"));
    QCOMPARE(rows.size(), 10);
    const QList<QByteArray> clean = rows[1].split(','); // 1 cm of noise, no outliers
    QCOMPARE(clean[4], clean[3]);                       // all clusters, none broken
}

void TestExperiments::polygonsAreMeasuredByVertices() {
    QTemporaryDir folder;
    QCOMPARE(run({"polygons", "--runs", "2", "--out", folder.path()}), 0);
    const auto rows = lines(folder.filePath("polygons.csv"));
    QCOMPARE(rows.value(0), QByteArray("vertices_true,algorithm,sigma,vertices,rmse,hit_share,area_error"));
    for (const QByteArray &row : rows.mid(1)) {
        const QList<QByteArray> fields = row.split(',');
        if (fields[0] != "6" || fields[1] != "AFTLS" ||
            fields[2] != "0.02") // a hexagon at the noise of the scan
            continue;
        QVERIFY2(fields[3].toDouble() < 20 && fields[4].toDouble() < 0.2, row.constData());
        QVERIFY2(fields[5].toDouble() > 0.9 && fields[6].toDouble() < 0.05, row.constData());
    }
    QCOMPARE(run({"log", "--out", folder.path(), "--force"}), 2);
}

void TestExperiments::refusesToOverwrite() {
    QTemporaryDir folder;
    QFile file(folder.filePath("corners.csv"));
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.close();
    QCOMPARE(run({"corners", "--runs", "1", "--max-points", "200", "--out", folder.path()}), 1);
    QVERIFY(error_.contains("corners.csv"));
    QCOMPARE(QDir(folder.path()).entryList(QDir::Files), QStringList("corners.csv"));
}

void TestExperiments::unknownExperimentIsAUsageError() {
    QCOMPARE(run({"nonsense"}), 2);
    QVERIFY(error_.contains("semicircle"));
}

QTEST_GUILESS_MAIN(TestExperiments)
#include "TestExperiments.moc"
