#include "tests/gui/ExperimentFiles.h"

#include <QTemporaryDir>
#include <QtTest>

// hermes-vector experiment: those of the overview paper.
class TestOverview : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void badOdometryIsCorrected();
    void corridorLoopCloses();
};

void TestOverview::badOdometryIsCorrected() { // overview figure 2
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

void TestOverview::corridorLoopCloses() { // overview figure 4: 46.71 m, 6 mm
    QTemporaryDir folder;
    QCOMPARE(runExperiment({"overview-loop", "--runs", "5", "--out", folder.path()}), 0);
    const auto rows = table(folder.filePath("overview-loop.csv"));
    QCOMPARE(rows.size(), 5 * 33);
    double way = 0;
    for (int i = 1; i < 33; ++i)
        way += std::hypot(rows[i]["x"].toDouble() - rows[i - 1]["x"].toDouble(),
                          rows[i]["y"].toDouble() - rows[i - 1]["y"].toDouble());
    QVERIFY2(std::abs(way - 46.71) < 0.001, qPrintable(QString::number(way)));
    for (int last = 32; last < rows.size(); last += 33)
        QVERIFY2(rows[last]["error_m"].toDouble() < 0.006, rows[last]["error_m"].constData());
}

QTEST_APPLESS_MAIN(TestOverview)
#include "TestOverview.moc"
