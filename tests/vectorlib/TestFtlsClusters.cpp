#include <vectorlib/io/CarmenLog.h>
#include <vectorlib/segmentation/EarSegmenter.h>
#include <vectorlib/vectorization/FtlsVectorizer.h>
#include <vectorlib/vectorization/IncVectorizer.h>

using namespace vectorlib;

using Cluster = std::vector<Vector2D<float>>;

/// Cuts clusters by FTLS, in float and in double, and by INC, and keeps what is wrong.
class CountComparison {
public:
    explicit CountComparison(double sigma) {
        inFloat_.settings.sigma = inDouble_.settings.sigma = byInc_.settings.sigma = sigma;
        inFloat_.settings.polyline = inDouble_.settings.polyline = byInc_.settings.polyline = false;
    }
    void add(const Cluster &points, const QString &name) {
        const std::vector<Vector2D<double>> exact(points.begin(), points.end());
        const std::vector<VectorizedLine> &lines = inFloat_(PointSpan<float>(points));
        const std::size_t some = lines.size(), same = inDouble_(PointSpan<double>(exact)).size(),
                          most = 2 * byInc_(PointSpan<double>(exact)).size() + 1;
        ++clusters;
        if (std::max(some, same) > most)
            complain(name, QStringLiteral("%1 lines in float, %2 in double, at most %3 expected"), some, same,
                     most);
        // Larger clusters are searched by blocks in float: near sigma each may find its own lines.
        if (points.size() <= BlockSums::smallCluster && std::max(some, same) - std::min(some, same) > 1)
            complain(name, QStringLiteral("%1 lines in float, %2 in double, %3 points"), some, same,
                     points.size());
        for (const VectorizedLine &line : lines)
            if (line.last - line.first > 2 &&
                line.sigma > inFloat_.settings.sigma * (1 + 2e-3)) // sums of blocks in float
                complain(name, QStringLiteral("points %1 to %2 do not fit, %3 ppm over sigma"), line.first,
                         line.last, std::size_t(1e6 * (line.sigma / inFloat_.settings.sigma - 1)));
    }

    int clusters = 0;
    QStringList faults;

private:
    void complain(const QString &name, const QString &text, std::size_t a, std::size_t b, std::size_t c) {
        faults.append(name + ": " + text.arg(a).arg(b).arg(c));
    }

    FtlsVectorizer<float> inFloat_;
    FtlsVectorizer<double> inDouble_;
    IncVectorizer<double> byInc_;
};

/// Walls of random lengths with corners between them, all with noise; few of them have as much as sigma.
static Cluster randomWalls(std::mt19937_64 &random, std::size_t count) {
    std::uniform_real_distribution<double> u(0, 1);
    std::normal_distribution<double> normal;
    const double noise = std::pow(10, -1 - 3 * u(random)),
                 bend = u(random) < 0.3 ? 0.3 * (u(random) - 0.5) : 0;
    const double step = 0.005 + 0.1 * u(random), corner = 0.2 * std::pow(u(random), 3);
    Cluster points;
    Vector2D<double> p(20 * u(random) - 10, 20 * u(random) - 10);
    double heading = 2 * pi * u(random);
    while (points.size() < count) {
        p += Vector2D<double>(std::cos(heading), std::sin(heading)) * step;
        points.emplace_back(Vector2D<float>(p + Vector2D<double>(normal(random), normal(random)) * noise));
        heading += u(random) < corner ? pi * (u(random) - 0.5) : bend * step;
    }
    return points;
}

/// FTLS of points in float and in double finds as many lines, and never falls apart: at most two for each of
/// INC.
class TestFtlsClusters : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void randomClusters() {
        std::mt19937_64 random(7);
        CountComparison compared(0.02);
        const int count = qEnvironmentVariableIntValue("HERMES_CLUSTERS");
        for (int i = 0; i < (count > 0 ? count : 20000); ++i)
            compared.add(
                randomWalls(random, std::size_t(std::pow(10, 0.4 + 0.003 * double(random() % 1000)))),
                QStringLiteral("cluster %1").arg(i));
        QVERIFY2(compared.faults.isEmpty(), qPrintable(compared.faults.mid(0, 10).join("\n")));
    }
    void realClusters_data() { rowsOf("log", {"belgioioso", "fhw", "freiburg-079", "intel", "orebro"}); }

    void realClusters() {
        QFETCH(QString, log);
        REAL_DATA(path, log + "-corrected.log.gz");
        QProcess unpack;
        unpack.start("zcat", {path});
        QVERIFY(unpack.waitForFinished());
        std::istringstream in(unpack.readAllStandardOutput().toStdString());
        const Expected<CarmenLog> read = readCarmenLog(in, log.toStdString());
        QVERIFY(read);
        EarSegmenter<float> segment;
        for (const double sigma : {0.01, 0.02, 0.03}) {
            CountComparison compared(sigma);
            for (std::size_t scan = 0; scan < read->scans.size(); ++scan) {
                Cluster points;
                read->scans[scan].appendPoints(points);
                const Segmentation &found = segment(PointSpan<float>(points));
                for (std::size_t c = 0; c < found.size(); ++c) {
                    Cluster cluster;
                    for (std::size_t i = found.starts[c]; i < found.starts[c + 1]; ++i)
                        cluster.push_back(points[std::size_t(found.order[i])]);
                    compared.add(cluster, QStringLiteral("scan %1 cluster %2").arg(scan).arg(c));
                }
            }
            QVERIFY(compared.clusters > 500);
            QVERIFY2(compared.faults.isEmpty(), qPrintable(compared.faults.mid(0, 10).join("\n")));
        }
    }
};
