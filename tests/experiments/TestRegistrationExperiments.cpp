#include "tests/experiments/ExperimentFiles.h"
#include "tests/gui/VectorProgram.h"
#include "vectorlib/experiments/RangeFit.h"
#include "vectorlib/experiments/ScanPairs.h"

using namespace hermes;
using namespace hermes::experiments;

using Point = vectorlib::Vector2D<double>;
using Segment = vectorlib::LineSegment2D<double>;
using Row = QMap<QByteArray, QByteArray>;

/// A room of 6 m x 4 m with a step in one corner; free space inside.
static World room() {
    World world;
    const Point corners[] = {{0, 0}, {6, 0}, {6, 3}, {4.5, 3}, {4.5, 4}, {0, 4}};
    for (std::size_t i = 0; i < std::size(corners); ++i) {
        const Point a = corners[i], b = corners[(i + 1) % std::size(corners)];
        world.edges.push_back({a.x, a.y, b.x, b.y});
    }
    return world;
}

/// The experiments of the registration paper, figures 2 to 9.
class TestRegistrationExperiments : public QObject {
    Q_OBJECT

    QTemporaryDir folder_;

    QString path(const QString &name) const { return folder_.filePath(name); }
    QByteArray experiment(const QStringList &arguments, const char *out) const {
        const Result r = run(QStringList("experiment") + arguments + QStringList{"--out", path(out)});
        if (r.status != 0)
            qWarning("%s", r.err.constData());
        return r.status == 0 ? r.out + '\n' : QByteArray();
    }

private Q_SLOTS:
    void initTestCase() { QVERIFY(folder_.isValid()); }

    void everyPairLiesOnItsEdge_data() {
        const Rows<int> row("pairing");
        for (const auto &[name, pairing] : {std::pair{"extracted", Pairing::Extracted},
                                            {"tight", Pairing::ExtractedTight},
                                            {"ftls", Pairing::ExtractedFtls},
                                            {"clean", Pairing::ExtractedClean},
                                            {"known", Pairing::KnownEdges},
                                            {"across", Pairing::AcrossEdges},
                                            {"fitted", Pairing::FittedRanges}})
            row(name, int(pairing));
    }

    void everyPairLiesOnItsEdge() {
        QFETCH(int, pairing);
        std::mt19937_64 random(3);
        const double noise = 0.002;
        for (int trial = 0; trial < 20; ++trial) {
            const vectorlib::Pose2D pose{2.5 + 0.05 * trial, 1.8, 0.3 * trial};
            const KnownScan scan(room(), pose, 400 + 100 * trial);
            QCOMPARE(scan.rays().size(), std::size_t(400 + 100 * trial));
            ScanPairs makePairs(Pairing(pairing), noise);
            const auto &pairs = makePairs(scan, 0, random);
            QVERIFY2(pairs.size() >= 6, saying(trial));
            for (const vectorlib::SegmentPair &p : pairs) {
                QVERIFY(p.moving.direction().dot(p.fixed.direction()) > 0.95);
                QVERIFY(std::abs(p.fixed.across(p.moving.begin())) < 0.03 &&
                        std::abs(p.fixed.across(p.moving.end())) < 0.03);
                QCOMPARE(p.weight, std::min(p.fixed.length(), p.moving.length()));
            }
            if (Pairing(pairing) == Pairing::Extracted)
                QCOMPARE(pairs.size(), std::size_t(6)); // the wall where the cluster begins is one
        }
    }

    void edgesThatFewRaysMeetAreNoPairs() {
        std::mt19937_64 random(1);
        const vectorlib::Pose2D middle{3, 2, 0};
        for (const Pairing pairing : {Pairing::Extracted, Pairing::ExtractedClean, Pairing::KnownEdges}) {
            ScanPairs makePairs(pairing, 0.01);
            QVERIFY(makePairs(KnownScan(World(), middle, 100), 0, random).empty()); // nothing to meet
            QVERIFY(makePairs(KnownScan(room(), middle, 0), 0, random).empty());
            QVERIFY(makePairs(KnownScan(room(), middle, 1), 0, random).empty());
            QVERIFY(makePairs(KnownScan(room(), middle, 6), 0, random).empty());
            QVERIFY(makePairs(KnownScan(room(), middle, 400), 7, random).empty()); // all shorter than 7 m
            World one;
            one.edges = {{-5, -1, 5, -1}}; // all rays that meet anything meet the same
            QCOMPARE(makePairs(KnownScan(one, {0, 0, 0}, 400), 0, random).size(), std::size_t(1));
        }
    }

    void observedDirectionsHaveNoise() {
        const QStringList scan{"observe", data("world.json"), "--pose", "0,0,0", "--scan", "90"};
        const QByteArray exact = run(scan).out, noisy = run(scan + QStringList{"--angle-noise", "1"}).out;
        const QList<QByteArray> a = exact.trimmed().split('\n'), b = noisy.trimmed().split('\n');
        QCOMPARE(a.size(), b.size());
        double largest = 0;
        for (int i = 1; i < a.size(); ++i) {
            const QList<QByteArray> p = a[i].split(','), q = b[i].split(',');
            const double x = p[0].toDouble(), y = p[1].toDouble(), u = q[0].toDouble(), v = q[1].toDouble();
            QVERIFY(std::abs(x * v - y * u) <
                    1e-9); // the points tell the direction that the ray should have had
            largest = std::max(largest, std::abs(std::hypot(x, y) - std::hypot(u, v)));
        }
        QVERIFY2(largest > 0.01 && largest < 1, saying(largest));
    }

    void rangesAreFittedWithoutBias() {
        std::mt19937_64 random(5);
        std::normal_distribution<double> normal(0, 0.1);
        const Point normalOfWall(0, 1); // y = -1, seen from x = 0.5 to 2.5
        double byDistance = 0, byRange = 0;
        constexpr int runs = 400;
        for (int i = 0; i < runs; ++i) {
            std::vector<Point> points;
            for (int k = 0; k <= 400; ++k) {
                const double angle =
                    std::atan2(-1, 0.5) + k * (std::atan2(-1, 2.5) - std::atan2(-1, 0.5)) / 400;
                const Point u(std::cos(angle), std::sin(angle));
                points.push_back(u * (-1 / u.y + normal(random)));
            }
            const auto sums = vectorlib::TlsSums::of(points.begin(), points.end());
            const Segment line =
                vectorlib::makeLine(vectorlib::PointSpan<double>(points), 0, 400, sums).segment;
            const Segment fitted = fitRanges(points, line);
            byDistance += line.direction().y / runs;
            byRange += fitted.direction().y / runs;
        }
        QVERIFY2(std::abs(byDistance) > 0.005, saying(byDistance));
        QVERIFY2(std::abs(byRange) < 0.002, saying(byRange));
    }

    void spaceOfTransformations() { // paper figures 2 to 4
        const QJsonObject summary = json(experiment({"registration-space"}, "space"));
        const QJsonObject collinear = summary["collinear"].toObject(), room = summary["room"].toObject();
        QVERIFY(std::abs(collinear["x_m"].toDouble() - 3) < 0.001);
        QVERIFY(std::abs(collinear["reliability"].toDouble() - std::sin(0.02)) < 1e-9);
        QVERIFY(std::abs(room["x_m"].toDouble() - 0.4) < 0.05 &&
                std::abs(room["y_m"].toDouble() + 0.3) < 0.05);
        QVERIFY(std::abs(room["alpha_deg"].toDouble() - 20) < 1);
        for (const QString &name : summary.keys()) { // erratum 9
            const QJsonObject one = summary[name].toObject();
            const double epsilon = one["epsilon_deg"].toDouble() * M_PI / 180;
            QVERIFY(std::abs(std::sin(2 * epsilon) - one["reliability"].toDouble()) < 1e-9);
        }
        QCOMPARE(table(path("space/registration-space.csv")).size(), 3 * (5 + 2 + 7));
        const QByteArray latex = contentOf(path("space/registration-space.tex"));
        QVERIFY(latex.contains("\\includegraphics") && latex.endsWith("\\end{document}\n"));
        if (hasMatplotlib())
            QCOMPARE(QDir(path("space")).entryList({"*.svg"}).size(), 4);
    }

    void runsAreAsManyAsPublished() {
        QVERIFY(!experiment({"accuracy", "--max-points", "100"}, "hundred").isEmpty());
        QCOMPARE(table(path("hundred/accuracy.csv"))[0]["runs"], QByteArray("100"));
        QVERIFY(!experiment({"accuracy", "--max-points", "100", "--runs", "7"}, "seven").isEmpty());
        QCOMPARE(table(path("seven/accuracy.csv"))[0]["runs"], QByteArray("7"));
        QCOMPARE(run({"experiment", "rotation", "--known-edges", "--out", path("no")}).status, 2);
    }

    void errorFallsWithPointsAndNoise() { // paper figure 6
        for (const bool known : {false, true}) {
            const char *out = known ? "accuracy-known" : "accuracy";
            QVERIFY(!experiment(QStringList{"accuracy", "--runs", "10"} +
                                    (known ? QStringList("--known-edges") : QStringList()),
                                out)
                         .isEmpty());
            QMap<QByteArray, double> error, ambiguity; // by noise and points, sums over the poses
            for (const Row &row : table(path(out) + "/accuracy.csv"))
                if (row["weighted"] == "0") {
                    error[row["sigma"] + ' ' + row["points"]] += row["d_t"].toDouble();
                    ambiguity[row["sigma"] + ' ' + row["points"]] += row["a_t"].toDouble();
                }
            for (const auto &sums : {error, ambiguity}) {
                const double points = sums["0.01 300"] / sums["0.01 3000"],
                             noise = known ? sums["0.1 300"] / sums["0.01 300"] : 100;
                QVERIFY2(points > 5 && points < 20, saying(points)); // linear
                QVERIFY2(noise > 50 && noise < 200, saying(noise));  // quadratic
            }
        }
    }

    void noiseAlongTheEdgeIsTheBias() {
        QVERIFY(!experiment({"registration-bias", "--runs", "20"}, "bias").isEmpty());
        QMap<QByteArray, Row> at; // 10 cm of noise, by segments and points
        for (const Row &row : table(path("bias/registration-bias.csv")))
            if (row["sigma"] == "0.1" && row["weighted"] == "0")
                at[row["segments"] + ' ' + row["points"]] = row;
        const auto value = [&](const char *key, const char *column) { return at[key][column].toDouble(); };
        const double known = value("known-edges 3000", "bias_t");
        QVERIFY(known > 0.3 * value("known-edges 3000", "d_t"));
        QVERIFY(known > 0.5 * value("known-edges 300", "bias_t")); // no fewer with more points
        for (const char *cause : {"across-edges", "fitted-ranges"}) {
            const QByteArray few = QByteArray(cause) + " 300", many = QByteArray(cause) + " 3000";
            QVERIFY2(value(many, "bias_t") < known / 10, cause);
            const double fall = value(few, "d_t") / value(many, "d_t");
            QVERIFY2(fall > 6 && fall < 16, saying(fall));
        }
        QVERIFY(value("extracted 3000", "d_t") > 20 * value("extracted-clean 3000", "d_t"));
    }

    void weightingHelpsMostAmongPillars_data() {
        const Rows<QStringList> row("options");
        row("extracted", QStringList());
        row("known edges", QStringList("--known-edges"));
    }

    void weightingHelpsMostAmongPillars() { // paper tables 1 and 2
        QFETCH(QStringList, options);
        const QByteArray out = options.isEmpty() ? "weighting" : "weighting-known";
        QVERIFY(!experiment(QStringList{"weighting", "--runs", "20"} + options, out).isEmpty());
        const QByteArray latex = contentOf(path(out) + "/weighting.tex");
        QVERIFY(latex.endsWith("\\end{document}\n") && latex.contains("published"));
        const auto rows = table(path(out) + "/weighting-tables.csv");
        QCOMPARE(rows.size(), 3);
        QCOMPARE(rows[2]["world"], QByteArray("pillars"));
        for (const char *ratio : {"ratio_a_t", "ratio_a_alpha", "ratio_d_t", "ratio_d_alpha"}) {
            const double square = rows[0][ratio].toDouble(), oblique = rows[1][ratio].toDouble(),
                         pillars = rows[2][ratio].toDouble();
            QVERIFY2(0 < pillars && pillars < oblique && oblique < square && square < 1, ratio);
        }
        for (const auto &row : rows)
            for (const char *correlation : {"corr_t", "corr_t_weighted"})
                QVERIFY2(row[correlation].toDouble() >= 0.4, row["world"] + ' ' + row[correlation]);
    }

    void weightsNarrowTheScatter() { // paper figure 8 against figure 7f
        QVERIFY(!experiment({"dispersion", "--runs", "10"}, "dispersion").isEmpty());
        double plain = 0, weighted = 0;
        for (const Row &row : table(path("dispersion/dispersion.csv")))
            if (row["world"] == "pillars")
                (row["weighted"] == "1" ? weighted : plain) +=
                    row["var_x"].toDouble() + row["var_y"].toDouble();
        QVERIFY2(weighted > 0 && weighted < plain / 2, saying("%1 %2", weighted, plain));
        if (!hasMatplotlib())
            return;
        QCOMPARE(QDir(path("dispersion")).entryList({"*.svg"}).size(), 14);
        QVERIFY(contentOf(path("dispersion/dispersion-a.svg")).contains("to scale"));
        QVERIFY(contentOf(path("dispersion/dispersion-a-enlarged.svg")).contains("enlarged 5 times"));
    }

    void reliabilityFallsWhereWallsAreHidden() { // paper figure 9
        QVERIFY(!experiment({"reliability"}, "reliability").isEmpty());
        double least = 1, most = 0;
        for (const Row &row : table(path("reliability/reliability.csv"))) {
            least = std::min(least, row["least_reliability"].toDouble());
            most = std::max(most, row["reliability"].toDouble());
        }
        QVERIFY2(least >= 0 && least < 0.9, saying(least));
        QVERIFY2(most > 0.95 && most <= 1, saying(most));
        if (hasMatplotlib())
            QVERIFY(
                contentOf(path("reliability/reliability-circles.svg")).contains("lowest single scan, R = "));
    }
};
