#include "vectorlib/experiments/QualityExperiment.h"
#include "vectorlib/io/CarmenLog.h"

using namespace hermes;
using namespace hermes::experiments;

/// AFTLS with post-processing beside Douglas-Peucker and split-and-merge as published, by the measures of
/// Schaefer et al., 2018, at equal numbers of vertices J up to 50, as there.
class TestQuality : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void measuresOfAKnownShift() {
        QualityCluster cluster; // a wall at 2 m, seen 10 cm too far by every ray, and one ray that goes past
        for (int i = -10; i <= 10; ++i) {
            const vectorlib::Vector2D<double> direction(std::cos(0.05 * i), std::sin(0.05 * i));
            cluster.add({direction, 2 / direction.x + 0.1, 2 / direction.x});
        }
        cluster.add({{0, 1}, 2, 2});
        QualityMeasures measures;
        measures.take(cluster, {{{2, -3}, {2, 3}}});
        QVERIFY(std::abs(measures.rmse() - 0.1) < 1e-12);
        QVERIFY(std::abs(measures.hitShare() - 21.0 / 22) < 1e-12);
        QVERIFY(measures.areaError() < 1e-12);
        QualityMeasures shifted; // the wall at 2.2 m encloses 21 % more
        shifted.take(cluster, {{{2.2, -3}, {2.2, 3}}});
        QVERIFY(std::abs(shifted.areaError() - 0.21) < 1e-12);
    }

    void verticesOfBrokenPolylines() {
        QCOMPARE(countVertices({}), std::size_t(0));
        QCOMPARE(countVertices({{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}}), std::size_t(3));
        QCOMPARE(countVertices({{{0, 0}, {1, 0}}, {{1, 0.1}, {1, 1}}}), std::size_t(4));
    }

    void polygons() {
        ExperimentOptions options;
        options.runs = 40;
        for (const auto &[key, row] : sorted(polygonExperiment(options))) {
            const auto [vertices, budget] = key;
            const QualityRow &aftls = row.at("AFTLS"), &dp = row.at("DP"), &sam = row.at("SAM");
            if (budget > largestBudget)
                continue;
            QVERIFY2(aftls.rmse < dp.rmse && aftls.areaError < dp.areaError, qPrintable(told(aftls, dp)));
            // With more vertices than the polygon has, both draw the noise, and neither is much better.
            if (vertices == 0 || vertices > 12 || budget <= std::size_t(vertices))
                QVERIFY2(aftls.rmse < sam.rmse && aftls.areaError < sam.areaError,
                         qPrintable(told(aftls, sam)));
            else
                QVERIFY2(aftls.rmse < 1.05 * sam.rmse && aftls.areaError < 1.1 * sam.areaError,
                         qPrintable(told(aftls, sam)));
            QVERIFY2(aftls.hitShare > 0.95, qPrintable(told(aftls, dp)));
        }
    }

    void realScans_data() {
        const Rows<QString> row("name");
        for (const char *name : {"intel", "freiburg-079", "fhw", "belgioioso", "orebro"})
            row(name, QString("%1-corrected.log.gz").arg(name));
    }

    void realScans() {
        QFETCH(QString, name);
        REAL_DATA(path, name);
        const auto rows = sorted(ofLog(path));
        QVERIFY(!rows.empty());
        for (const auto &[key, row] : rows) {
            const QualityRow &aftls = row.at("AFTLS"), &dp = row.at("DP"), &sam = row.at("SAM");
            if (key.second > largestBudget || aftls.scans < 30) // few scans are so plain
                continue;
            QVERIFY2(aftls.rmse < dp.rmse, qPrintable(told(aftls, dp)));
            QVERIFY2(aftls.rmse < sam.rmse, qPrintable(told(aftls, sam)));
        }
    }

private:
    static constexpr std::size_t largestBudget = 50; // with more, noise is what is drawn
    using ByAlgorithm = std::map<std::string, QualityRow>;
    // By number of true vertices and J.
    static std::map<std::pair<int, std::size_t>, ByAlgorithm> sorted(const std::vector<QualityRow> &rows) {
        std::map<std::pair<int, std::size_t>, ByAlgorithm> result;
        for (const QualityRow &row : rows)
            result[{row.verticesTrue, row.budget}][row.algorithm] = row;
        return result;
    }
    static std::vector<QualityRow> ofLog(const QString &path) {
        QProcess unzip;
        unzip.start("gzip", {"-dc", path});
        unzip.waitForFinished();
        std::istringstream text(unzip.readAllStandardOutput().toStdString());
        const auto log = vectorlib::readCarmenLog(text, path.toStdString());
        if (!log)
            return {};
        ExperimentOptions options;
        options.runs = 10;
        return logExperiment(log->scans, options);
    }
    static QString told(const QualityRow &a, const QualityRow &b) {
        return QString(saying("%1 vertices, J %2, %3 scans: RMSE %4, %5 %6; a %7, %8; f %9", a.verticesTrue,
                              a.budget, a.scans, a.rmse, QString::fromStdString(b.algorithm), b.rmse,
                              a.areaError, b.areaError, a.hitShare));
    }
};
