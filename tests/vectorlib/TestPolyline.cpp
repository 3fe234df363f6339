#include "Vectorizers.h"

#include <vectorlib/vectorization/Polyline.h>

using namespace vectorlib;
using Lines = Algorithm::Lines;
using Points = Algorithm::Points;

/// Joining the lines of a cluster: thesis 6.3.3.
class TestPolyline : public QObject {
    Q_OBJECT

    // Points along y = f(x), every 2 cm, with noise across.
    template <typename Function>
    static Points curve(Function f, int count, double noise = 0) {
        std::mt19937 random(4);
        std::normal_distribution<double> normal;
        Points points;
        for (int i = 0; i < count; ++i)
            points.emplace_back(0.02 * i, f(0.02 * i) + noise * normal(random));
        return points;
    }

    // The lines between consecutive cuts.
    static Lines linesOf(const Points &points, const std::vector<std::size_t> &cuts) {
        Lines lines;
        for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
            lines.push_back(makeLine<double>(
                points, cuts[i], cuts[i + 1] - 1,
                TlsSums::of(points.begin() + long(cuts[i]), points.begin() + long(cuts[i + 1]))));
        return lines;
    }

    static Lines joined(const Points &points, Lines lines, const VectorizerSettings &settings = {}) {
        PrefixSums sums;
        sums.assign(PointSpan<double>(points));
        PolylineJoiner join;
        join(PointSpan<double>(points), sums, settings, lines);
        return lines;
    }

    static int interruptions(const Lines &lines) {
        int count = 0;
        for (std::size_t i = 1; i < lines.size(); ++i)
            count += !(lines[i - 1].segment.end() == lines[i].segment.begin());
        return count;
    }

    // The sum of the squared distances of all points from the edges of their lines.
    static double squaresOf(const Points &points, const Lines &lines) {
        double squares = 0;
        for (const VectorizedLine &line : lines)
            for (std::size_t i = line.first; i <= line.last; ++i)
                squares += std::pow(line.segment.across(points[i]), 2);
        return squares;
    }

private Q_SLOTS:
    void cornersAreIntersections() {
        const Points points = curve([](double x) { return std::abs(x - 1); }, 101);
        const Lines apart = linesOf(points, {0, 50, 101}), lines = joined(points, apart);
        QCOMPARE(interruptions(lines), 0);
        QVERIFY((lines[0].segment.end() - Vector2D<double>(1, 0)).norm() < 1e-9);
        QVERIFY(lines[0].segment.begin() == apart[0].segment.begin());
        QVERIFY(lines[1].segment.end() == apart[1].segment.end());
    }

    // The first line ends 16 cm after the corner, the second begins 16 cm before it in reverse: farther than
    // delta.
    void overrunCornersAreFound() {
        Points points;
        for (int i = 0; i <= 200; ++i)
            points.emplace_back(i < 100 ? Vector2D<double>(2, 0.02 * i)
                                        : Vector2D<double>(2 - 0.02 * (i - 100), 2));
        for (const std::size_t change : {108, 93}) {
            const Lines lines = joined(points, linesOf(points, {0, change, 201}));
            QCOMPARE(lines.size(), std::size_t(2));
            QCOMPARE(interruptions(lines), 0);
            QVERIFY((lines[0].segment.end() - Vector2D<double>(2, 2)).norm() < 0.05);
        }
    }

    void stepKeepsItsEnds() {
        const Points points = curve([](double x) { return x < 0.995 ? 2 : 2.2; }, 100);
        const Lines apart = linesOf(points, {0, 50, 100}), lines = joined(points, apart);
        QCOMPARE(lines.size(), std::size_t(2));
        QCOMPARE(interruptions(lines), 1);
        QVERIFY(lines[0].segment.end() == apart[0].segment.end());
    }

    // Parallel lines a little apart over points that go on: the edges share a vertex between them and lean.
    void smallStepIsBridged() {
        const Points points = curve([](double x) { return x < 0.995 ? 2 : 2.04; }, 100);
        const Lines apart = linesOf(points, {0, 50, 100}), lines = joined(points, apart);
        QCOMPARE(interruptions(lines), 0);
        QVERIFY(std::abs(lines[0].segment.end().y - 2.02) < 0.003);
        QVERIFY(lines[0].segment.begin().y < 1.999 && lines[1].segment.end().y > 2.041);
        QVERIFY(std::abs(lines[0].line.signedDistance({1, 2})) < 1e-9); // the line stays that of its points
        VectorizerSettings narrow;
        narrow.delta = 0.07; // the step is more than half of it, and no third line helps
        narrow.sigma = 0.005;
        QCOMPARE(interruptions(joined(points, apart, narrow)), 1);
    }

    void inflectionTakesThreeLines() { // thesis figure 6.6
        const Points points = curve([](double x) { return 2 - 0.12 / (1 + std::exp(-12 * (x - 1))); }, 101);
        VectorizerSettings settings;
        settings.delta = 0.08;
        const Lines lines = joined(points, linesOf(points, {0, 50, 101}), settings);
        QCOMPARE(lines.size(), std::size_t(3));
        QCOMPARE(interruptions(lines), 0);
        QCOMPARE(lines[1].first, std::size_t(33));
        QCOMPARE(lines[1].last, std::size_t(66));
        for (const VectorizedLine &line : lines)
            QVERIFY(line.sigma <= settings.sigma);
        settings.sigma = -0.02; // as good as 0: no three lines fit
        QCOMPARE(joined(points, linesOf(points, {0, 50, 101}), settings).size(), std::size_t(2));
    }

    void invalidLinesInterrupt() {
        Points points = curve([](double) { return 2; }, 60);
        points[30].x = std::nan("");
        Lines lines = linesOf(points, {0, 20, 40, 60});
        QVERIFY(!lines[1].line.isValid());
        lines = joined(points, lines);
        QCOMPARE(lines.size(), std::size_t(3));
        QVERIFY(lines[0].segment.isFinite() && lines[2].segment.isFinite());
    }

    void nothingToJoin() {
        QCOMPARE(joined({}, {}).size(), std::size_t(0));
        const Points points = curve([](double) { return 2; }, 10);
        QCOMPARE(joined(points, linesOf(points, {0, 10})).size(), std::size_t(1));
    }

    // Against a plain search: no vertex can be moved to where the points are much nearer.
    void relaxationFindsTheLeastSquares() {
        const Points points = curve([](double x) { return 0.1 * std::sin(3 * x); }, 120, 0.02);
        const Lines lines = joined(points, linesOf(points, {0, 17, 43, 60, 81, 100, 120}));
        QCOMPARE(interruptions(lines), 0);
        const double squares = squaresOf(points, lines);
        for (std::size_t vertex = 0; vertex <= lines.size(); ++vertex)
            for (const double shift : {-0.004, -0.001, 0.001, 0.004}) {
                Lines moved = lines;
                const Vector2D<double> step(0, shift);
                if (vertex > 0)
                    moved[vertex - 1].segment = {lines[vertex - 1].segment.begin(),
                                                 lines[vertex - 1].segment.end() + step};
                if (vertex < lines.size())
                    moved[vertex].segment = {lines[vertex].segment.begin() + step,
                                             lines[vertex].segment.end()};
                QVERIFY2(squaresOf(points, moved) > 0.995 * squares, saying(vertex));
            }
    }

    void curveStaysContinuous_data() {
        const Rows<int> row("algorithm");
        for (int a = 1; a < int(algorithms.size()); ++a)
            row(algorithms[std::size_t(a)].name, a);
    }

    void curveStaysContinuous() {
        QFETCH(int, algorithm);
        const Points points = curve([](double x) { return 0.4 * std::sin(2 * x); }, 300, 0.005);
        const Lines lines = algorithms[std::size_t(algorithm)].run(points, {});
        QVERIFY(lines.size() > 4);
        QCOMPARE(interruptions(lines), 0);
    }
};
