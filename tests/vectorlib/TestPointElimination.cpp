#include "Vectorizers.h"

#include "tests/support/AllocationCounter.h"

using namespace vectorlib;
using Points = Algorithm::Points;

/// The rivals of thesis 6.5 as they are published, and that no vectorizer allocates memory once it has grown.
class TestPointElimination : public QObject {
    Q_OBJECT

    template <typename Vectorizer>
    static std::vector<std::size_t> keptPoints(Vectorizer &vectorize, const Points &points) {
        std::vector<std::size_t> kept;
        for (const VectorizedLine &line : vectorize(points))
            kept.push_back(line.first);
        kept.push_back(points.size() - 1);
        return kept;
    }

    // The textbook's Douglas-Peucker.
    static void recursively(const Points &points, std::size_t first, std::size_t last, double tolerance,
                            std::vector<std::size_t> &kept) {
        const LineSegment2D<double> chord(points[first], points[last]);
        double most = tolerance;
        std::size_t split = first;
        for (std::size_t i = first + 1; i < last; ++i)
            if (chord.distance(points[i]) > most) {
                most = chord.distance(points[i]);
                split = i;
            }
        if (split == first) {
            kept.push_back(last);
        } else {
            recursively(points, first, split, tolerance, kept);
            recursively(points, split, last, tolerance, kept);
        }
    }

    template <typename Vectorizer>
    static std::size_t allocationsOf(Vectorizer vectorize, const std::vector<Vector2D<float>> &points) {
        return allocationsOnceGrown(3, [&] { vectorize(points); });
    }

private Q_SLOTS:
    void douglasPeuckerKeepsWhatTheRecursiveFormKeeps() {
        DouglasPeuckerVectorizer<double> vectorize;
        for (std::uint64_t seed = 1; seed <= 50; ++seed) {
            const Points points = roomScan(seed, 600);
            std::vector<std::size_t> expected{0};
            recursively(points, 0, points.size() - 1, 0.06, expected);
            QVERIFY2(keptPoints(vectorize, points) == expected, saying("seed %1", seed));
        }
    }

    void reumannWitkamFollowsTheFirstTwoPoints() {
        ReumannWitkamVectorizer<double> vectorize; // tolerance 0.06
        vectorize.direction = ReumannWitkamVectorizer<double>::Direction::NextPoint;
        const Points points{{0, 0}, {1, 0}, {2, 0.05}, {3, 0.05}, {4, 0.07}, {5, 0.09}, {5, 1}, {5, 2}};
        // The line y = 0 holds to the fourth point; from there the line through the fourth and the fifth.
        const std::vector<std::size_t> expected{0, 3, 5, 7};
        QCOMPARE(keptPoints(vectorize, points), expected);
    }

    void reumannWitkamTakesItsDirectionBeyondTheTolerance() {
        ReumannWitkamVectorizer<double> vectorize; // tolerance 0.06
        // The second and third point are within the tolerance of the first: the fourth gives the direction.
        const Points points{{0, 0}, {0.01, 0.01}, {0.02, -0.01}, {0.5, 0}, {1, 0.05}, {1.5, -0.05}, {2, 0.2}};
        const std::vector<std::size_t> expected{0, 5, 6};
        QCOMPARE(keptPoints(vectorize, points), expected);
        vectorize.direction = ReumannWitkamVectorizer<double>::Direction::NextPoint;
        QVERIFY(keptPoints(vectorize, points).size() > 3);
        QCOMPARE(vectorize(Points{{0, 0}, {0.01, 0.01}, {0.02, 0}}).size(), std::size_t(1)); // none beyond
    }

    // Thesis figures 6.8 and 6.9: from 200 to 20,000 points 1.4 times as many lines; adjacent points: 8
    // times.
    void reumannWitkamFindsNoMoreLinesInDenserScans() {
        ReumannWitkamVectorizer<double> vectorize;
        const auto growth = [&vectorize] {
            double few = 0, many = 0;
            for (std::uint64_t seed = 1; seed <= 10; ++seed) {
                few += double(vectorize(roomScan(seed, 1000)).size());
                many += double(vectorize(roomScan(seed, 20000)).size());
            }
            return many / few;
        };
        const double tolerance = growth();
        QVERIFY2(tolerance < 3, saying(tolerance));
        vectorize.direction = ReumannWitkamVectorizer<double>::Direction::NextPoint;
        QVERIFY(growth() > 2 * tolerance);
    }

    void linesRunThroughKeptPoints() {
        DouglasPeuckerVectorizer<double> vectorize;
        const Points points = roomScan(1, 600);
        const auto &lines = vectorize(points);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            QVERIFY(lines[i].segment.begin() == points[lines[i].first]);
            QVERIFY(lines[i].line.c >= 0);
            QVERIFY(std::abs(lines[i].line.signedDistance(lines[i].segment.end())) < 1e-9);
            if (i > 0)
                QVERIFY(lines[i].segment.begin() == lines[i - 1].segment.end());
        }
    }

    void toleranceIsThreeSigma() {
        DouglasPeuckerVectorizer<double> vectorize;
        vectorize.settings.sigma = 0.1;
        QCOMPARE(vectorize(Points{{0, 0}, {1, 0.29}, {2, 0}}).size(), std::size_t(1));
        QCOMPARE(vectorize(Points{{0, 0}, {1, 0.31}, {2, 0}}).size(), std::size_t(2));
        vectorize.settings.sigmas = 2;
        QCOMPARE(vectorize(Points{{0, 0}, {1, 0.29}, {2, 0}}).size(), std::size_t(2));
    }

    void measuringIsOptional() {
        DouglasPeuckerVectorizer<double> vectorize;
        const Points points = roomScan(2, 600);
        const auto measured = keptPoints(vectorize, points);
        vectorize.settings.measure = false;
        QCOMPARE(keptPoints(vectorize, points), measured);
        QCOMPARE(vectorize(points)[0].sums.n, 0.0);
    }

    void splitAndMergeMergesCollinearNeighbours() {
        SplitAndMergeVectorizer<double> vectorize;
        // A door ajar in a long wall: what lies on either side of it is split off and stays apart, the wall
        // itself whole.
        Points points;
        for (int i = 0; i < 300; ++i)
            points.emplace_back(0.01 * i, i >= 150 && i < 180 ? 2.5 : 2.0);
        const auto &lines = vectorize(points);
        QCOMPARE(lines.size(), std::size_t(3));
        QCOMPARE(lines[1].first, std::size_t(150));
        QCOMPARE(lines[1].last, std::size_t(179));
    }

    void splitAndMergeSplitsACorner() {
        SplitAndMergeVectorizer<double> vectorize;
        Points points;
        for (int i = 0; i < 200; ++i)
            points.emplace_back(i < 100 ? Vector2D<double>(3, 0.02 * i)
                                        : Vector2D<double>(3 - 0.02 * (i - 100), 2));
        const auto &lines = vectorize(points);
        QCOMPARE(lines.size(), std::size_t(2));
        QVERIFY((lines[0].segment.end() - Vector2D<double>(3, 2)).norm() < 0.02);
        QVERIFY(lines[0].segment.end() == lines[1].segment.begin());
    }

    void incEndsALineAtTheFirstPointTooMany() {
        IncVectorizer<double> vectorize;
        vectorize.settings.sigma = 0.01;
        vectorize.settings.polyline = false;
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const Points points = roomScan(seed, 600);
            const auto &lines = vectorize(points);
            for (std::size_t i = 0; i + 2 < lines.size(); ++i) {
                const auto begin = points.begin() + long(lines[i].first),
                           end = points.begin() + long(lines[i].last) + 1;
                QVERIFY(lines[i].sums.n == 2 || fitsWithin(TlsSums::of(begin, end), 0.01));
                QVERIFY(!fitsWithin(TlsSums::of(begin, end + 1), 0.01));
            }
        }
    }

    void incLastSinglePoint() {
        IncVectorizer<double> vectorize;
        vectorize.settings.sigma = 0.001;
        Points points;
        for (int i = 0; i < 50; ++i)
            points.emplace_back(2, 0.02 * i);
        points.emplace_back(1.5, 1.0); // alone beside the line
        const auto &lines = vectorize(points);
        QCOMPARE(lines.size(), std::size_t(2));
        QCOMPARE(lines[1].first, std::size_t(49));
        QCOMPARE(lines[1].last, std::size_t(50));
        QCOMPARE(vectorize(Points{{0, 0}, {1, 0}, {2, 5}}).size(), std::size_t(1)); // too few for two lines
    }

    void noAllocationOnceGrown() {
        std::vector<Vector2D<float>> points;
        for (const Vector2D<double> &p : roomScan(3, 2000))
            points.emplace_back(p);
        AftlsVectorizer<float> simplex;
        simplex.search = AftlsVectorizer<float>::Search::NelderMead;
        QCOMPARE(allocationsOf(TlsVectorizer<float>(), points), std::size_t(0));
        QCOMPARE(allocationsOf(AftlsVectorizer<float>(), points), std::size_t(0));
        QCOMPARE(allocationsOf(simplex, points), std::size_t(0));
        QCOMPARE(allocationsOf(IncVectorizer<float>(), points), std::size_t(0));
        QCOMPARE(allocationsOf(DouglasPeuckerVectorizer<float>(), points), std::size_t(0));
        QCOMPARE(allocationsOf(ReumannWitkamVectorizer<float>(), points), std::size_t(0));
        QCOMPARE(allocationsOf(SplitAndMergeVectorizer<float>(), points), std::size_t(0));
    }
};
