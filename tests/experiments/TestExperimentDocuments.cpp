#include "tests/experiments/ExperimentFiles.h"
#include "tests/support/Latex.h"

#include <QTemporaryDir>
#include <QtTest>

/// The LaTeX documents of hermes-vector experiment.
class TestExperimentDocuments : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void documentsAreComplete_data() {
        QTest::addColumn<QStringList>("arguments");
        QTest::addColumn<int>("documents");
        const QString log = QStringLiteral(TEST_DATA_DIR "/vector/corrected.log");
        const QStringList few{"--runs", "1", "--max-points", "300"}, once{"--runs", "1"};
        for (const char *name :
             {"edges", "corners", "room", "accuracy", "dispersion", "weighting", "reliability"})
            QTest::newRow(name) << QStringList(name) + few << 1;
        for (const char *name : {"polygons", "rotation"})
            QTest::newRow(name) << QStringList(name) + once << 1;
        for (const char *name : {"segmentation-room", "segmentation-objects", "criterion", "criterion-time",
                                 "hausdorff-criteria", "adaptive-threshold", "threshold",
                                 "registration-space", "free-leaps", "free-copy"})
            QTest::newRow(name) << QStringList(name) << 1;
        QTest::newRow("semicircle") << QStringList{"semicircle", "--max-points", "100"} << 4;
        QTest::newRow("potential-pairs") << QStringList{"potential-pairs", "--runs", "1"} << 2;
        QTest::newRow("free-approach") << QStringList{"free-approach", "--every", "40"} << 1;
        for (const char *name : {"registration-bias", "overview-steps", "baseline"})
            QTest::newRow(name) << QStringList(name) + once << 1;
        for (const char *name : {"empty-room", "corridor", "laboratory", "real-segmentation"})
            QTest::newRow(name) << QStringList{name, "--log", log} << 1;
        QTest::newRow("log") << QStringList{"log", "--runs", "1", "--log", log} << 1;
    }

    /// Every document of an experiment is whole, and pdflatex compiles it where it is installed.
    void documentsAreComplete() {
        QFETCH(QStringList, arguments);
        QFETCH(int, documents);
        static const hermes::Latex latex;
        QTemporaryDir folder;
        QByteArray error;
        QVERIFY2(runExperiment(arguments + QStringList{"--out", folder.path()}, &error) == 0, error);
        const QStringList names = QDir(folder.path()).entryList({"*.tex"});
        QCOMPARE(names.size(), documents);
        for (const QString &name : names) {
            const QList<QByteArray> text = lines(folder.filePath(name));
            QVERIFY(text.first().startsWith("\\documentclass") && text.last() == "\\end{document}");
            QVERIFY(text.join().contains("tikzpicture"));
            const QByteArray fault =
                latex.missing().isEmpty() ? hermes::Latex::fault(folder.filePath(name)) : QByteArray();
            QVERIFY2(fault.isEmpty(), fault.constData());
        }
        if (!latex.missing().isEmpty())
            QSKIP(latex.missing().constData());
    }
};

QTEST_GUILESS_MAIN(TestExperimentDocuments)
#include "TestExperimentDocuments.moc"
