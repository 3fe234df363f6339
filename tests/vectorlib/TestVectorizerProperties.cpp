#include "Vectorizers.h"

using namespace vectorlib;
using Points = Algorithm::Points;

Q_DECLARE_METATYPE(Algorithm)

static void algorithmRows(const QStringList &without = {}) {
    const Rows<Algorithm> row("algorithm");
    for (const Algorithm &a : algorithms)
        if (!isOneOf(a, without))
            row(a.name, a);
}

static VectorizerSettings settingsOf(bool polyline) {
    VectorizerSettings settings;
    settings.polyline = polyline;
    return settings;
}

static double distanceOfEnds(const LineSegment2D<double> &a, const LineSegment2D<double> &b) {
    return std::max((a.begin() - b.begin()).norm(), (a.end() - b.end()).norm());
}

static const char *at(std::uint64_t seed) {
    static QByteArray text;
    text = "seed " + QByteArray::number(qulonglong(seed));
    return text.constData();
}

/// What holds of every vectorizer, on scans of random rooms and on input that is no scan at all.
class TestVectorizerProperties : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void intervalsPartitionTheCluster_data() { algorithmRows(); }

    void intervalsPartitionTheCluster() {
        QFETCH(Algorithm, algorithm);
        std::mt19937 random(5);
        std::uniform_real_distribution<double> u(-1, 1);
        for (std::size_t n = 2; n < 300; n += n < 12 ? 1 : 7) {
            Points points; // a random walk: corners anywhere
            Vector2D<double> p;
            for (std::size_t i = 0; i < n; ++i)
                points.push_back(p += Vector2D<double>(u(random), u(random)) * 0.1);
            for (const bool polyline : {false, true}) {
                std::size_t next = 0;
                for (const VectorizedLine &line : algorithm.run(points, settingsOf(polyline))) {
                    QVERIFY2(line.first == next, at(n));
                    // Those that eliminate points count the point between two lines with the second.
                    QVERIFY2(line.last >= line.first + (isOneOf(algorithm, {"dp", "rw"}) ? 0 : 1), at(n));
                    next = line.last + 1;
                }
                QVERIFY2(next == n, at(n));
            }
        }
    }

    void movesWithThePoints_data() { algorithmRows(); }

    void movesWithThePoints() {
        QFETCH(Algorithm, algorithm);
        std::mt19937 random(8);
        std::uniform_real_distribution<double> u(-1, 1);
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const Transformation2D motion(20 * u(random), 20 * u(random), pi * u(random));
            const Points points = roomScan(seed, 500);
            Points moved;
            for (const Vector2D<double> &p : points)
                moved.push_back(motion * p);
            for (const bool polyline : {false, true}) {
                const auto expected = algorithm.run(points, settingsOf(polyline));
                const auto lines = algorithm.run(moved, settingsOf(polyline));
                QVERIFY2(lines.size() == expected.size(), at(seed));
                for (std::size_t i = 0; i < lines.size(); ++i) {
                    QVERIFY2(lines[i].first == expected[i].first, at(seed));
                    QVERIFY2(std::abs(lines[i].sigma - expected[i].sigma) < 1e-8, at(seed));
                    QVERIFY2(distanceOfEnds(lines[i].segment, motion * expected[i].segment) < 1e-6, at(seed));
                }
            }
        }
    }

    void keepsItsVarianceFarFromTheOrigin_data() { algorithmRows(); }

    void keepsItsVarianceFarFromTheOrigin() { // erratum 3
        QFETCH(Algorithm, algorithm);
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const Points points = roomScan(seed, 500);
            Points far;
            for (const Vector2D<double> &p : points)
                far.push_back(p + Vector2D<double>(10000, -10000));
            const auto expected = algorithm.run(points, {}), lines = algorithm.run(far, {});
            QVERIFY2(lines.size() == expected.size(), at(seed));
            for (std::size_t i = 0; i < lines.size(); ++i)
                if (expected[i].sums.n > 2) // two points lie on their line; only rounding is left
                    QVERIFY2(std::abs(std::pow(lines[i].sigma / expected[i].sigma, 2) - 1) < 1e-6, at(seed));
        }
    }

    // The others go through the points from one end: where lines change depends on which.
    void sameLinesInReverse_data() { algorithmRows({"aftls by Nelder-Mead", "inc", "rw", "sam"}); }

    void sameLinesInReverse() {
        QFETCH(Algorithm, algorithm);
        int same = 0;
        for (std::uint64_t seed = 1; seed <= 100; ++seed) {
            const Points points = roomScan(seed, 1000), reversed(points.rbegin(), points.rend());
            const auto expected = algorithm.run(points, settingsOf(false));
            auto lines = algorithm.run(reversed, settingsOf(false));
            std::reverse(lines.begin(), lines.end());
            bool agree = lines.size() == expected.size();
            for (std::size_t i = 0; agree && i < lines.size(); ++i)
                for (const Vector2D<double> end : {expected[i].segment.begin(), expected[i].segment.end()})
                    agree = agree && std::abs(lines[i].line.signedDistance(end)) < 0.005;
            if (!isOneOf(algorithm, {"ftls", "aftls"}))
                QVERIFY2(agree, at(seed));
            same += agree;
        }
        // FTLS, where AFTLS starts, meets half way; where noise makes two places for a break point equally
        // good, each end leads to its own.
        QVERIFY2(same >= 99, saying("%1 of 100", same));
    }

    // A strip along the first two points says nothing of one along the last two.
    void asGoodInReverse_data() { algorithmRows({"rw"}); }

    // Lines that grow from one end are not those from the other, but as many, and as near to the points.
    void asGoodInReverse() {
        QFETCH(Algorithm, algorithm);
        double sum = 0, reversedSum = 0;
        int near = 0;
        for (std::uint64_t seed = 1; seed <= 300; ++seed) {
            const Points points = roomScan(seed, 1000), reversed(points.rbegin(), points.rend());
            const auto lines = algorithm.run(points, settingsOf(false));
            const auto reversedLines = algorithm.run(reversed, settingsOf(false));
            const int more = int(reversedLines.size()) - int(lines.size());
            QVERIFY2(more >= -1 && more <= 1, at(seed));
            const double e = errorOf(lines), reversedE = errorOf(reversedLines);
            near += std::abs(e - reversedE) < 0.05 * e;
            sum += e;
            reversedSum += reversedE;
        }
        // A simplex collapses where it does.
        const double apart = isOneOf(algorithm, {"aftls by Nelder-Mead"}) ? 0.02 : 0.01;
        QVERIFY2(std::abs(sum / reversedSum - 1) < apart, saying(sum / reversedSum));
        if (isOneOf(algorithm, {"tls", "aftls"}))
            QVERIFY2(near >= 296, saying("%1 of 300", near));
    }

    // One line whatever sigma is, and a strip that is not the line.
    void obeysSigma_data() { algorithmRows({"tls", "rw"}); }

    void obeysSigma() {
        QFETCH(Algorithm, algorithm);
        const VectorizerSettings settings = settingsOf(false);
        for (std::uint64_t seed = 1; seed <= 50; ++seed) {
            const Points points = roomScan(seed, 700);
            const auto lines = algorithm.run(points, settings);
            QVERIFY2(errorOf(lines) <= settings.sigma * settings.sigma * (1 + 1e-9), at(seed));
            for (const VectorizedLine &line : lines) {
                if (isOneOf(algorithm, {"ftls", "inc"}) && line.sums.n > 2)
                    QVERIFY2(line.sigma <= settings.sigma * (1 + 1e-9), at(seed));
                if (isOneOf(algorithm, {"dp", "sam"}) && line.sums.n > 3)
                    for (std::size_t i = line.first; i <= line.last; ++i)
                        QVERIFY2(std::abs(line.line.signedDistance(points[i])) <=
                                     3 * settings.sigma * (1 + 1e-9),
                                 at(seed));
            }
        }
    }

    void sumsAreThoseOfTheInterval_data() { algorithmRows(); }

    void sumsAreThoseOfTheInterval() {
        QFETCH(Algorithm, algorithm);
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const Points points = roomScan(seed, 300);
            for (const VectorizedLine &line : algorithm.run(points, {})) {
                const TlsSums sums =
                    TlsSums::of(points.begin() + long(line.first), points.begin() + long(line.last) + 1);
                QVERIFY2(line.sums.n == sums.n && (line.sums.mean - sums.mean).norm() < 1e-9, at(seed));
                QVERIFY2(std::abs(line.sums.xx - sums.xx) < 1e-8 && std::abs(line.sums.xy - sums.xy) < 1e-8 &&
                             std::abs(line.sums.yy - sums.yy) < 1e-8,
                         at(seed));
                double squares = 0;
                for (std::size_t i = line.first; i <= line.last; ++i)
                    squares += std::pow(line.line.signedDistance(points[i]), 2);
                QVERIFY2(std::abs(line.sigma - std::sqrt(squares / sums.n)) < 1e-6, at(seed));
            }
        }
    }

    void degenerateInput_data() {
        Rows<Algorithm, QVector<QPointF>, double, int>("algorithm", "points", "sigma",
                                                       "lines"); // lines: -1 is any number
        const double nan = std::nan(""), infinite = HUGE_VAL;
        QVector<QPointF> corner, cross, circle;
        for (int i = 0; i < 40; ++i)
            corner << (i < 20 ? QPointF(2, 0.1 * i) : QPointF(4 - 0.1 * i, 2));
        for (int i = 0; i < 64; ++i) {
            cross << QPointF(1 + (i % 4 == 0) - (i % 4 == 2), 1 + (i % 4 == 1) - (i % 4 == 3));
            circle << QPointF(0.01 * std::cos(i * pi / 32), 0.01 * std::sin(i * pi / 32));
        }
        const auto with = [&corner](int index, QPointF p) {
            QVector<QPointF> points = corner;
            points[index] = p;
            return points;
        };
        const auto scaled = [&corner](double factor) {
            QVector<QPointF> points = corner;
            for (QPointF &p : points)
                p *= factor;
            return points;
        };
        // Rounding of the sums over all points parts the two that coincide.
        const QVector<QPointF> coinciding = {{0.769, 0.263},     {2, 0},
                                             {2, 0.1},           {2, 0.2},
                                             {2, 0.3},           {2, 0.4},
                                             {2, 0.5},           {2, 0.6},
                                             {2, -12.1},         {14.851, 14.906},
                                             {14.906, 14.906},   {14.906, 14.906},
                                             {1.85, 8.4},        {-0.001, -0.001},
                                             {2, 0.2},           {2, 0.463},
                                             {-0.255, 2},        {1.1, 2},
                                             {0.257, 1.795},     {-20.735, -32.768},
                                             {-32.64, 0.257},    {1.539, -12.287},
                                             {-31.737, -12.285}, {-6.137, -12.285},
                                             {19.463, -0.001},   {-0.001, -12.284},
                                             {-20.473, -12.284}, {30.727, -12.283},
                                             {-9.209, -12.283},  {27.655, -24.569},
                                             {-12.273, 2},       {0, 2},
                                             {0.1, 2},           {0, 0}};
        for (const Algorithm &a : algorithms) {
            const auto row = [&a](const char *name, const QVector<QPointF> &points, double sigma, int lines) {
                QTest::newRow(qPrintable(QString("%1: %2").arg(a.name, name)))
                    << a << points << sigma << lines;
            };
            row("empty", {}, 0.02, 0);
            row("one point", {{1, 2}}, 0.02, 0);
            row("two equal points", {{1, 2}, {1, 2}}, 0.02, 1);
            row("two points", {{1, 2}, {1, 3}}, 0.02, 1);
            row("three points of a corner", {{1, 2}, {1, 3}, {0, 3}}, 0.02, -1);
            row("all equal", QVector<QPointF>(50, {1, 2}), 0.02, 1);
            row("isotropic within sigma", circle, 0.02, isOneOf(a, {"rw"}) ? -1 : 1);
            row("isotropic", cross, 0.02, a.name == QString("tls") ? 1 : -1);
            row("sigma 0", corner, 0, -1);
            row("sigma negative", corner, -0.02, -1);
            row("sigma no number", corner, nan, -1);
            row("sigma infinite", corner, infinite, 1);
            row("first point no number", with(0, {nan, 0}), 0.02, -1);
            row("some point no number", with(10, {2, nan}), 0.02, -1);
            row("second point no number", with(1, {nan, nan}), 0.02, -1);
            row("last point infinite", with(39, {infinite, 2}), 0.02, -1);
            row("squares overflow", with(30, {1e200, -1e200}), 0.02, -1);
            row("moments beyond all numbers", scaled(1e100), 0.02, -1);
            row("moments below all numbers", scaled(1e-81), 0.02, -1);
            row("length beyond all numbers", {{-1e308, 0}, {1e308, 0}}, 0.02, -1);
            row("points almost at one place", {{0, 0}, {0, 2e-162}}, 0.02, -1);
            row("a moment beyond all numbers", {{0, -1.8e146}, {-4.8e154, 0}, {0, 0}}, 0, -1);
            row("sigma 0 and points at one place", coinciding, 0, -1);
            row("all no numbers", QVector<QPointF>(20, {nan, nan}), 0.02, -1);
        }
    }

    void degenerateInput() {
        FETCH(Algorithm, algorithm, QVector<QPointF>, points, double, sigma);
        const std::size_t least = isOneOf(algorithm, {"dp", "rw"}) ? 1 : 2;
        QFETCH(int, lines);
        Points p;
        for (const QPointF &q : points)
            p.emplace_back(q.x(), q.y());
        for (const bool polyline : {false, true}) {
            VectorizerSettings settings = settingsOf(polyline);
            settings.sigma = sigma;
            const auto found = algorithm.run(p, settings);
            if (lines >= 0)
                QCOMPARE(int(found.size()), lines);
            std::size_t next = 0;
            for (const VectorizedLine &line : found) {
                QCOMPARE(line.first, next);
                next = line.last + 1;
                QVERIFY(next >= line.first + least);
                QVERIFY(!line.line.isValid() || std::abs(line.line.normal().squaredNorm() - 1) < 1e-6);
                QVERIFY(line.segment.direction().isFinite());
                QVERIFY(std::isfinite(line.line.a) && std::isfinite(line.line.b) &&
                        std::isfinite(line.line.c));
                QVERIFY(std::isfinite(line.sigma) && line.segment.isFinite() && isFinite(line.sums));
            }
            QCOMPARE(next, found.empty() ? 0 : p.size());
        }
    }
};
