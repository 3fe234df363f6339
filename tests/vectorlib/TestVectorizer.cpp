#include <vectorlib/vectorization/FtlsVectorizer.h>

#include "tests/support/AllocationCounter.h"

using namespace vectorlib;
using Points = std::vector<Vector2D<float>>;

// A polyline through the corners with `each` points a side and noise across.
static Points polyline(const std::vector<Vector2D<double>> &corners, int each, double sigma, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise;
    Points points;
    for (std::size_t c = 0; c + 1 < corners.size(); ++c) {
        const LineSegment2D<double> side(corners[c], corners[c + 1]);
        for (int i = 0; i < each; ++i)
            points.emplace_back(side.begin() + side.direction() * (side.length() * i / each) +
                                side.normal() * sigma * noise(random));
    }
    return points;
}

static Vector2D<float> onRay(std::size_t ray, double range) {
    const double angle = 0.01 * static_cast<double>(ray);
    return Vector2D<float>(Vector2D<double>(std::cos(angle), std::sin(angle)) * range);
}

static const std::vector<Vector2D<double>> staircase{{2, -2}, {2, 0}, {1, 0}, {1, 1},
                                                     {0, 1},  {0, 2}, {-2, 2}};

class TestVectorizer : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void tlsIsOneLine() {
        TlsVectorizer<float> vectorize;
        const Points points = polyline({{1, 0}, {1, 3}}, 200, 0.01, 1);
        const auto &lines = vectorize(points);
        QCOMPARE(lines.size(), std::size_t(1));
        QCOMPARE(lines[0].first, std::size_t(0));
        QCOMPARE(lines[0].last, std::size_t(199));
        QVERIFY(std::abs(lines[0].line.c - 1) < 0.005);
        QVERIFY(std::abs(lines[0].sigma - 0.01) < 0.002);
    }

    void findsTheSidesOfAStaircase() {
        FtlsVectorizer<float> vectorize;
        for (unsigned seed = 1; seed <= 20; ++seed) {
            const auto &lines = vectorize(polyline(staircase, 100, 0.01, seed));
            QVERIFY2(lines.size() == 6, saying("seed %1: %2 lines", seed, lines.size()));
            for (std::size_t i = 0; i + 1 < lines.size(); ++i)
                QVERIFY((lines[i].segment.end() - staircase[i + 1]).norm() < 0.05);
        }
    }

    void intervalsPartitionTheCluster() {
        FtlsVectorizer<float> vectorize;
        std::mt19937 random(5);
        std::uniform_real_distribution<float> u(-1, 1);
        for (int n = 2; n < 300; n += 7) {
            Points points;
            Vector2D<float> p;
            for (int i = 0; i < n; ++i)
                points.push_back(p += Vector2D<float>(u(random), u(random)) * 0.1f);
            std::size_t next = 0;
            for (const VectorizedLine &line : vectorize(points)) {
                QCOMPARE(line.first, next);
                QVERIFY(line.last > line.first);
                next = line.last + 1;
            }
            QCOMPARE(next, points.size());
        }
    }

    void everyLineKeepsSigma() {
        FtlsVectorizer<float> vectorize;
        vectorize.settings.sigma = 0.015;
        for (unsigned seed = 1; seed <= 20; ++seed)
            for (const VectorizedLine &line : vectorize(polyline(staircase, 80, 0.01, seed)))
                QVERIFY(line.sigma <= 0.015 * (1 + 1e-9));
    }

    void noiseFreeCornersAreExact() {
        FtlsVectorizer<float> vectorize;
        vectorize.settings.sigma = 1e-4;
        const auto &lines = vectorize(polyline({{3, -1}, {3, 2}, {-1, 2}}, 50, 0, 1));
        QCOMPARE(lines.size(), std::size_t(2));
        QVERIFY((lines[0].segment.end() - Vector2D<double>(3, 2)).norm() < 1e-3);
        QVERIFY(lines[0].segment.end() == lines[1].segment.begin());
    }

    // Thesis figure 6.6: two nearly parallel lines whose intersection lies far from where one changes to the
    // other.
    void badIntersectionIsCorrected() {
        Points points;
        for (int i = 0; i < 120; ++i) {
            const double x = 0.02 * i, bend = 1 / (1 + std::exp(-(x - 1.2) * 6));
            points.emplace_back(float(x), float(2 - 0.12 * bend));
        }
        FtlsVectorizer<float> vectorize;
        vectorize.settings.sigma = 0.03;
        vectorize.settings.delta = 0.1;
        double worst = 0;
        for (const VectorizedLine &line : vectorize(points))
            for (Vector2D<double> corner : {line.segment.begin(), line.segment.end()}) {
                double nearest = 1e9;
                for (const Vector2D<float> &p : points)
                    nearest = std::min(nearest, (corner - Vector2D<double>(p)).norm());
                worst = std::max(worst, nearest);
            }
        QVERIFY2(worst < 0.12, saying(worst));
    }

    // Where ranges jump by 100 m within a block, sums in float are good for nothing.
    void correctedLinesHaveExactSums() {
        Points points;
        const std::vector<int> ranges = {32, 0, 2,  53, 1,  1, 1, 2, 1,  2, 1,  2,  1,  4,  2,  3,  2,  3,
                                         2,  3, 2,  3,  2,  3, 1, 3, 2,  3, 2,  3,  2,  3,  2,  48, 48, 0,
                                         0,  0, 48, 48, 48, 3, 2, 0, 50, 0, 53, 50, 53, 10, 13, 13};
        for (const int range : ranges)
            points.push_back(onRay(points.size(), 2.0 * range));
        for (int i = 0; i < 15; ++i)
            points.push_back(onRay(points.size(), 27.756));
        points.insert(points.end(), 2, Vector2D<float>());
        FtlsVectorizer<float> vectorize;
        for (const VectorizedLine &line : vectorize(points))
            QVERIFY(line.sums.n < 4 || line.sigma <= 0.02);
    }

    // Two parallel walls, which are joined only by lines beyond a sigma of 0.
    void negativeSigmaCorrectsNoLine() {
        Points points;
        for (int i = 0; i < 64; ++i)
            points.emplace_back(i < 32 ? 2.0f : 2.03125f, float(i) / 64);
        FtlsVectorizer<float> vectorize;
        for (const double sigma : {0.0, -0.02, -1e30}) {
            vectorize.settings.sigma = sigma;
            const auto &lines = vectorize(points);
            QCOMPARE(lines.size(), std::size_t(2));
            QCOMPARE(lines[0].sigma + lines[1].sigma, 0.0);
        }
    }

    void degenerateInput_data() {
        const Rows<QVector<QPointF>, int> row("points", "lines");
        row("empty", {}, 0);
        row("one point", {{1, 2}}, 0);
        row("two equal points", {{1, 2}, {1, 2}}, 1);
        row("all equal", QVector<QPointF>(50, {1, 2}), 1);
        row("two points", {{1, 2}, {1, 3}}, 1);
    }

    void degenerateInput() {
        FETCH(QVector<QPointF>, points, int, lines);
        Points p;
        for (const QPointF &q : points)
            p.emplace_back(float(q.x()), float(q.y()));
        FtlsVectorizer<float> ftls;
        TlsVectorizer<float> tls;
        QCOMPARE(int(ftls(p).size()), lines);
        QCOMPARE(int(tls(p).size()), lines);
        for (const VectorizedLine &line : ftls(p))
            QVERIFY(std::isfinite(line.sigma) && line.segment.isFinite());
    }

    void lastSinglePoint() {
        FtlsVectorizer<float> vectorize;
        vectorize.settings.sigma = 0.001;
        Points points = polyline({{2, 0}, {2, 1}}, 50, 0, 1);
        points.emplace_back(1.5f, 1.0f); // alone beside the line
        const auto &lines = vectorize(points);
        QCOMPARE(lines.size(), std::size_t(2));
        QCOMPARE(lines[1].first, std::size_t(49));
        QCOMPARE(lines[1].last, std::size_t(50));
    }

    void farFromTheOrigin() { // erratum 3
        std::vector<Vector2D<double>> near, far;
        for (const Vector2D<float> &p : polyline(staircase, 100, 0.01, 3)) {
            near.emplace_back(p);
            far.push_back(Vector2D<double>(p) + Vector2D<double>(10000, 10000));
        }
        FtlsVectorizer<double> vectorize;
        std::vector<double> sigmas;
        for (const VectorizedLine &line : vectorize(near))
            sigmas.push_back(line.sigma);
        const auto &lines = vectorize(far);
        QCOMPARE(lines.size(), sigmas.size());
        for (std::size_t i = 0; i < lines.size(); ++i)
            QVERIFY(std::abs(lines[i].sigma * lines[i].sigma / (sigmas[i] * sigmas[i]) - 1) < 1e-6);
    }

    void noAllocationOnceGrown() {
        FtlsVectorizer<float> vectorize;
        const Points points = polyline(staircase, 100, 0.01, 1);
        const std::size_t more = allocationsOnceGrown(3, [&] { vectorize(points); });
        QCOMPARE(more, std::size_t(0));
    }
};
