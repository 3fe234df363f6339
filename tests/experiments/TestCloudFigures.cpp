#include "tests/experiments/ExperimentFiles.h"
#include "tests/gui/VectorProgram.h"
#include "vectorlib/experiments/FewestLines.h"
#include "vectorlib/experiments/MeanBand.h"
#include "vectorlib/vectorization/FtlsVectorizer.h"

using namespace hermes::experiments;
using Points = std::vector<vectorlib::Vector2D<double>>;

static std::size_t fewestByTrying(const Points &points, std::size_t first, double sigma) {
    std::size_t fewest = points.size() - first;
    for (std::size_t end = first + 1; end <= points.size(); ++end) {
        const auto sums = vectorlib::TlsSums::of(points.begin() + long(first), points.begin() + long(end));
        if (end == first + 1 || vectorlib::fitsWithin(sums, sigma))
            fewest = std::min(fewest, 1 + fewestByTrying(points, end, sigma));
    }
    return fewest;
}

static Points randomWalk(std::uint64_t seed, int count) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(-0.1, 0.1);
    Points points;
    vectorlib::Vector2D<double> p;
    for (int i = 0; i < count; ++i) {
        const double x = u(random), y = u(random);
        points.push_back(p += vectorlib::Vector2D<double>(x, y));
    }
    return points;
}

/// hermes-vector experiment: figures 5.3 to 5.5, 6.1 to 6.3 and 6.7 to 6.13 of the thesis, and the options of
/// segmentation and vectorization that go with them.
class TestCloudFigures : public QObject, protected TestFolder {
    Q_OBJECT

private Q_SLOTS:
    void init() { empty(); }

    void fewestLinesAreTheFewest() {
        for (std::uint64_t seed = 1; seed <= 100; ++seed) {
            const Points points = randomWalk(seed, 12);
            QVERIFY2(fewestLines(vectorlib::PointSpan<double>(points), 0.03) ==
                         fewestByTrying(points, 0, 0.03),
                     saying("seed %1", seed));
        }
        vectorlib::FtlsVectorizer<double> ftls;
        ftls.settings = {0.05, 0.1, false};
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const Points points = randomWalk(seed, 300);
            QVERIFY2(fewestLines(vectorlib::PointSpan<double>(points), 0.05) <= ftls(points).size(),
                     saying("seed %1", seed));
        }
        QCOMPARE(fewestLines(vectorlib::PointSpan<double>(Points()), 0.05), std::size_t(0));
    }

    void bandOfAMean() {
        const MeanBand band = MeanBand::of({1, 2, 3, 4, 5}); // t = 2.776, s / sqrt(5) = 0.7071
        QCOMPARE(band.mean, 3.0);
        QVERIFY(std::abs(band.high - 3 - 1.963) < 0.01);
        QVERIFY(std::abs(band.low - 3 + 1.963) < 0.01);
        QCOMPARE(MeanBand::of({7}).high, 7.0);
        QVERIFY(std::abs(MeanBand::of({0, 2}).high - 1 - 12.7062) < 1e-3);
        QVERIFY(std::abs(MeanBand::of({0, 0, 3}).high - 1 - 4.3027) < 1e-3);
        std::mt19937_64 random(1);
        std::normal_distribution<double> normal;
        int within = 0;
        for (int i = 0; i < 2000; ++i) {
            std::vector<double> runs(50);
            for (double &run : runs)
                run = normal(random);
            const MeanBand some = MeanBand::of(runs);
            within += some.low <= 0 && 0 <= some.high;
        }
        QVERIFY2(std::abs(within - 1900) < 60, saying(within));
    }

    // Thesis 6.1.4: without noise the error stays at 0 to the corner, then grows; with noise it goes up and
    // down; a threshold lets the first line run past the corner, where the optimum does not.
    void thresholdRunsPastTheCorner() {
        const Result r = ran({"experiment", "threshold", "--out", path()});
        const QJsonObject precise = json(r.out)["precise"].toObject(),
                          noised = json(r.out)["noised"].toObject(),
                          all = json(r.out)["vectorizations"].toObject();
        QVERIFY(precise["sigma_at_corner_m"].toDouble() < 1e-9);
        QVERIFY(precise["grows_after_corner"].toBool());
        QVERIFY(noised["falls_before_corner"].toInt() > 5);
        const int corner = json(r.out)["corner_point"].toInt();
        const QJsonObject inc = all["INC"].toObject(), optimum = all["optimum"].toObject(),
                          aftls = all["AFTLS"].toObject();
        QVERIFY(inc["break_point"].toInt() > corner + 2);
        QVERIFY(std::abs(optimum["break_point"].toInt() - corner) <= 2);
        QCOMPARE(aftls["break_point"], optimum["break_point"]);
        QVERIFY(inc["rms_m"].toDouble() > 1.1 * optimum["rms_m"].toDouble());
        QVERIFY(inc["first_line_turned_deg"].toDouble() > optimum["first_line_turned_deg"].toDouble());
        QCOMPARE(table(path("threshold.csv")).size(), 99);
        for (const char *picture : {"threshold-clouds.svg", "threshold-lines.svg"})
            QVERIFY2(contentOf(path(picture)).endsWith("</svg>\n"), picture);
    }

    // Thesis 5.2.2: without a lower bound near points are false outliers; without an upper one far clusters
    // are merged; of the outliers hardly one more stays.
    void adaptiveThresholdNeedsItsBounds() {
        ran({"experiment", "adaptive-threshold", "--out", path()});
        QMap<QByteArray, QMap<QByteArray, QByteArray>> of;
        for (const auto &row : table(path("adaptive-threshold.csv"))) {
            of[row["case"]] = row;
            QVERIFY(contentOf(path("adaptive-threshold-" + row["case"] + ".svg")).endsWith("</svg>\n"));
        }
        QCOMPARE(of.size(), 4);
        QVERIFY(of["near-unbounded"]["points_lost"].toInt() > 50);
        QCOMPARE(of["near-bounded"]["points_lost"].toInt(), 0);
        QVERIFY(of["far-unbounded"]["clusters"].toInt() < of["far-bounded"]["clusters"].toInt());
        QCOMPARE(of["far-bounded"]["clusters"], of["far-bounded"]["clusters_true"]);
        QVERIFY(of["far-unbounded"]["outliers_found"].toInt() <= of["far-bounded"]["outliers_found"].toInt());
    }

    void scansOfALogInColours() {
        ran({"experiment", "real-segmentation", "--log", data("corrected.log"), "--out", path()});
        QCOMPARE(table(path("real-segmentation.csv")).size(), 3);
        for (const char *kind : {"corridor", "empty-room", "laboratory"})
            QVERIFY(contentOf(path(qPrintable(QString("real-segmentation-%1.svg").arg(kind))))
                        .contains("outliers"));
    }

    void capturesHaveRealScans() {
        writeCapture(path("two.pcap"), 400, {{0xC0A801C9, 2368, 5}, {0xC0A801CA, 2369, 6}});
        for (const char *name : {"empty-room", "corridor", "laboratory", "real-segmentation"}) {
            const Result r = ran({"experiment", name, "--log", path("two.pcap"), "--port", "2369", "--out",
                                  path(), "--force"});
            QVERIFY2(r.err.contains("read 192.168.1.202"), r.err.constData());
            const auto rows = table(path(qPrintable(QString("%1.csv").arg(name))));
            QVERIFY2(rows[0]["points"].toInt() > 2000, name);
        }
        const auto rows = table(path("laboratory.csv"));
        QCOMPARE(rows[0]["algorithm"], QByteArray("FTLS"));
        QCOMPARE(rows[0]["time_percent"].toDouble(), 0.0);
        const double reference = rows[0]["lines_reference"].toDouble();
        for (const auto &row : rows)
            QVERIFY(std::abs(row["lines_percent"].toDouble() -
                             100 * (row["lines"].toDouble() / reference - 1)) < 0.01);
        refused(run({"experiment", "corridor", "--out", path(), "--force"}), 2, "--log");
    }
    void realCapture() {
        REAL_DATA(capture, "hdl32e-outdoor.pcap");
        ran({"experiment", "laboratory", "--log", capture, "--out", path()});
        QVERIFY(table(path("laboratory.csv"))[0]["lines_reference"].toInt() > 0);
    }

    void cloudsAndTablesStandBesideThePlots() {
        ran({"experiment", "semicircle", "--max-points", "20", "--out", path()});
        QVERIFY(contentOf(path("semicircle-cloud.svg")).endsWith("</svg>\n"));
        ran({"experiment", "edges", "--runs", "2", "--max-points", "200", "--noise", "0.002", "--out",
             path()});
        QVERIFY(contentOf(path("edges-cloud.svg")).contains("noise 2 mm"));
        QVERIFY(contentOf(path("edges.tex")).contains("200 & 4 & +0.0 & +0.0"));
        QByteArrayList algorithms;
        for (const auto &row : table(path("edges.csv"))) {
            algorithms << row["algorithm"];
            QVERIFY(row["area_low_m2"].toDouble() <= row["area_m2"].toDouble());
            QVERIFY(row["area_high_m2"].toDouble() >= row["area_m2"].toDouble());
        }
        for (const char *variant : {"AFTLS-NM", "AFTLS-polar", "RW-adjacent"})
            QVERIFY2(algorithms.contains(variant), variant);
    }

    void searchAndCoordinatesAreOptions() {
        const QString room = data("room.csv");
        const QStringList aftls{"vectorize", room, "--algorithm", "aftls"};
        const Result descent = run(aftls), same = run(aftls + QStringList{"--search", "descent"}),
                     simplex = run(aftls + QStringList{"--search", "nelder-mead"});
        QCOMPARE(simplex.status, 0);
        QCOMPARE(same.out, descent.out);
        QVERIFY(simplex.out != descent.out);
        refused(run({"vectorize", room, "--search", "nelder-mead"}), 2, "expected aftls");
        const Result cartesian = run({"segment", room, "--k", "2"}),
                     polar = run({"segment", room, "--k", "2", "--coordinates", "polar"});
        QCOMPARE(polar.status, 0);
        QCOMPARE(polar.out.count('\n'), cartesian.out.count('\n'));
        QVERIFY(polar.out != cartesian.out);
        QCOMPARE(run({"segment", room, "--coordinates", "bent"}).status, 2);
    }
};
