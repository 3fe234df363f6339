#include "Vectorizers.h"

#include <vectorlib/segmentation/EarSegmenter.h>
#include <vectorlib/vectorization/OptimalVectorizer.h>

using namespace vectorlib;
using Lines = Algorithm::Lines;
using Points = Algorithm::Points;

constexpr auto nelderMead = AftlsVectorizer<double>::Search::NelderMead;

// The three synthetic environments of thesis figures 6.8 to 6.10, seen from the origin.
struct Environment {
    const char *name;
    std::vector<Points> walls; // polylines, free space on their left, from begin to end
    int lines() const {
        int count = 0;
        for (const Points &wall : walls)
            count += int(wall.size()) - 1;
        return count;
    }
    std::vector<LineSegment2D<double>> segments() const {
        std::vector<LineSegment2D<double>> all;
        for (const Points &wall : walls)
            for (std::size_t i = 0; i + 1 < wall.size(); ++i)
                all.emplace_back(wall[i], wall[i + 1]);
        return all;
    }
};
const std::vector<Environment> environments = {
    {"four solitary edges",
     {{{-1, -2}, {1, -2}}, {{2.5, -1}, {2, 1}}, {{1, 2}, {-1, 2.5}}, {{-2, 1}, {-2.5, -1}}}},
    {"five consecutive edges", {{{-2, -1}, {-1, -2}, {2, -2}, {2, 1}, {0.5, 2}, {-1.5, 2}}}},
    {"fifteen edges of a room",
     {{{-2.9, -0.8},
       {-3.4, -2.4},
       {-1.5, -2.1},
       {-0.9, -3.5},
       {0.3, -2.4},
       {1.9, -3.3},
       {2.2, -1.7},
       {3.9, -1}},
      {{3.5, 0.3}, {2.3, 1.1}, {2.8, 2.8}, {1, 2.4}, {0.1, 3.6}},
      {{-0.6, 2.9}, {-2.1, 3.6}, {-1.9, 1.6}, {-3.3, 1.2}, {-2.6, 0}}}},
};

// Segments a scan and vectorizes every cluster.
static int countLines(const Environment &environment, int rays, std::uint64_t seed,
                      const Algorithm &algorithm) {
    SimulatedScanner<double> scanner(seed);
    scanner.rays = rays;
    scanner.sigma = 0.005;
    const Points scan = scanner(environment.segments(), {0, 0, 0.7});
    EarSegmenter<double> segment;
    segment.settings.maxThreshold = 0.2;
    const Segmentation &clusters = segment(scan);
    int count = 0;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        Points points;
        for (std::size_t i = 0; i < clusters.size(c); ++i)
            points.push_back(scan[std::size_t(clusters.order[clusters.starts[c] + i])]);
        count += int(algorithm.run(points, {}).size());
    }
    return count;
}

class TestAftlsVectorizer : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void findsTheCornerThatFtlsOverruns() {
        Points points; // 60 points up a wall, 60 along the next
        for (int i = 0; i < 120; ++i)
            points.emplace_back(i < 60 ? Vector2D<double>(2, 0.02 * i)
                                       : Vector2D<double>(2 - 0.02 * (i - 60), 1.2));
        FtlsVectorizer<double> ftls;
        AftlsVectorizer<double> aftls;
        // A third wall, so that the searches from both ends do not meet in the corner.
        for (int i = 0; i < 400; ++i)
            points.emplace_back(0.8, 1.2 + 0.02 * i);
        QVERIFY(ftls(points)[0].last >= 62);
        const Lines lines = aftls(points);
        QCOMPARE(lines.size(), std::size_t(3));
        QVERIFY(lines[0].last == 59 || lines[0].last == 60); // the corner itself lies on both lines
        QVERIFY((lines[0].segment.end() - Vector2D<double>(2, 1.2)).norm() < 1e-9);
    }

    void isNeverWorseThanFtls_data() { falseAndTrue("simplex", "descent", "Nelder-Mead"); }

    void isNeverWorseThanFtls() {
        QFETCH(bool, simplex);
        AftlsVectorizer<double> aftls;
        FtlsVectorizer<double> ftls;
        if (simplex)
            aftls.search = nelderMead;
        aftls.settings.polyline = ftls.settings.polyline = false;
        for (std::uint64_t seed = 1; seed <= 300; ++seed)
            for (const double sigma : {0.012, 0.02, 0.1}) {
                aftls.settings.sigma = ftls.settings.sigma = sigma;
                const Points points = roomScan(seed, 200 + int(seed));
                const Lines before = ftls(points);
                const Lines &after = aftls(points);
                QCOMPARE(after.size(), before.size());
                QVERIFY2(errorOf(after) <= errorOf(before) * (1 + 1e-9), saying("seed %1", seed));
            }
    }

    void optimumIsThatOfAllBreakPoints() {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> u(0, 1);
        OptimalVectorizer<double> optimal;
        optimal.settings.polyline = false;
        optimal.lines = 3;
        for (int trial = 0; trial < 20; ++trial) {
            Points points;
            for (int i = 0; i < 14; ++i)
                points.emplace_back(0.1 * i, u(random));
            const auto squares = [&points](int first, int end) {
                return sumOfSquares(TlsSums::of(points.begin() + first, points.begin() + end));
            };
            double least = HUGE_VAL;
            for (int b1 = 2; b1 <= 10; ++b1)
                for (int b2 = b1 + 2; b2 <= 12; ++b2)
                    least = std::min(least, squares(0, b1) + squares(b1, b2) + squares(b2, 14));
            const Lines lines = optimal(points);
            QCOMPARE(lines.size(), std::size_t(3));
            QVERIFY(std::abs(optimal.error() - least / 14) < 1e-12);
            QVERIFY(std::abs(errorOf(lines) - least / 14) < 1e-12);
        }
    }

    void optimumOfMoreLinesThanPoints() {
        OptimalVectorizer<double> optimal;
        optimal.lines = 10;
        QCOMPARE(optimal(Points{}).size(), std::size_t(0));
        QCOMPARE(optimal(Points{{1, 2}}).size(), std::size_t(0));
        QCOMPARE(optimal(Points{{1, 2}, {2, 2}, {2, 3}, {3, 3}, {4, 3}}).size(), std::size_t(2));
        optimal.lines = 0;
        QCOMPARE(optimal(Points{{1, 2}, {2, 2}, {2, 3}}).size(), std::size_t(1));
    }

    // The full thousand rooms are in TestAftlsOptimum.
    void comesNearTheOptimum() {
        AftlsVectorizer<double> aftls;
        OptimalVectorizer<double> optimal;
        aftls.settings.polyline = optimal.settings.polyline = false;
        int near = 0;
        for (std::uint64_t seed = 1; seed <= 100; ++seed) {
            const Points points = roomScan(seed, 360);
            const Lines &lines = aftls(points);
            optimal.lines = lines.size();
            optimal(points);
            QVERIFY(errorOf(lines) >= optimal.error() * (1 - 1e-9));
            near += errorOf(lines) <= 1.01 * optimal.error();
        }
        QVERIFY2(near >= 93, saying("%1 of 100 rooms", near));
    }

    void simplexKeepsTwoPointsToALine() { // erratum 4: tau < b_1, and every line has two
                                          // points
        std::mt19937 random(6);
        std::uniform_real_distribution<double> u(-0.1, 0.1);
        AftlsVectorizer<double> aftls;
        aftls.search = nelderMead;
        aftls.simplex.tau = 50;
        for (int trial = 0; trial < 50; ++trial) {
            Points points;
            Vector2D<double> p;
            for (int i = 0; i < 40; ++i)
                points.push_back(p += Vector2D<double>(u(random), u(random)));
            for (const VectorizedLine &line : aftls(points))
                QVERIFY(line.last > line.first);
        }
    }

    // Thesis 6.5: the error area of AFTLS keeps falling with the number of points where that of FTLS stays.
    void cornersGetBetterWithMorePoints() {
        const Environment &environment = environments[1];
        const auto cornerError = [&environment](auto &vectorize, int rays) {
            double sum = 0;
            int count = 0;
            for (std::uint64_t seed = 1; seed <= 20; ++seed) {
                SimulatedScanner<double> scanner(seed);
                scanner.rays = rays;
                Points points;
                for (const Vector2D<double> &p : scanner(environment.segments(), {0, 0, pi * 1.05}))
                    points.push_back(p);
                const Transformation2D toWorld(0, 0, pi * 1.05);
                for (const VectorizedLine &line : vectorize(points))
                    for (const Vector2D<double> end : {line.segment.begin(), line.segment.end()}) {
                        double nearest = HUGE_VAL;
                        for (const LineSegment2D<double> &wall : environment.segments())
                            nearest = std::min(nearest, wall.distance(toWorld * end));
                        sum += nearest;
                        ++count;
                    }
            }
            return sum / count;
        };
        FtlsVectorizer<double> ftls;
        AftlsVectorizer<double> aftls;
        const double few = cornerError(aftls, 1000), many = cornerError(aftls, 16000);
        QVERIFY2(many < 0.5 * few, saying("%1 m, then %2 m", few, many));
        const double ftlsMany = cornerError(ftls, 16000);
        QVERIFY2(many < 0.3 * ftlsMany, saying("%1 m, FTLS %2 m", many, ftlsMany));
    }

    void rightNumberOfLines_data() {
        const Rows<int, int> row("environment", "algorithm");
        for (int e = 0; e < int(environments.size()); ++e)
            for (const int a : {1, 2, 4}) // the TLS family
                row(qPrintable(QString("%1: %2").arg(algorithms[a].name, environments[e].name)), e, a);
    }

    void rightNumberOfLines() {
        FETCH(int, environment, int, algorithm);
        for (const int rays : {1000, 2000, 5000, 20000}) {
            const Environment &e = environments[environment];
            const int scans = rays > 5000 ? 5 : 20;
            int found = 0;
            for (int seed = 1; seed <= scans; ++seed)
                found += countLines(e, rays, seed, algorithms[algorithm]);
            const double expected = scans * e.lines();
            QVERIFY2(std::abs(found - expected) <= 0.01 * expected,
                     saying("%1 rays: %2 lines, %3 expected", rays, found, expected));
        }
    }
};
