#include <vectorlib/vectorization/AftlsVectorizer.h>

using namespace vectorlib;

/// A random chain of lines with noise; some with stray points, some far from the origin.
template <typename Scalar>
static std::vector<Vector2D<Scalar>> randomCluster(std::mt19937 &random) {
    std::uniform_real_distribution<double> u(0, 1);
    const std::size_t count = 2 + random() % (random() % 4 ? 900 : 4000);
    std::normal_distribution<double> noise(0, u(random) * 0.03);
    const double step = 0.002 + 0.05 * u(random) * u(random), corner = 0.05 * u(random) * u(random);
    const double offset = random() % 3 ? 0 : 1000 * u(random), stray = random() % 4 ? 0 : 0.02;
    std::vector<Vector2D<Scalar>> points;
    Vector2D<double> p(offset, -offset);
    double heading = 7 * u(random);
    for (std::size_t i = 0; i < count; ++i) {
        if (u(random) < corner)
            heading += (u(random) - 0.5) * 4;
        p += Vector2D<double>(std::cos(heading), std::sin(heading)) * step;
        Vector2D<double> q(p.x + noise(random), p.y + noise(random));
        if (u(random) < stray)
            q += Vector2D<double>(u(random), u(random));
        points.emplace_back(q);
    }
    return points;
}

template <typename Scalar>
static TlsSums exactSums(const std::vector<Vector2D<Scalar>> &points, std::size_t first, std::size_t end) {
    return TlsSums::of(points.begin() + std::ptrdiff_t(first), points.begin() + std::ptrdiff_t(end));
}

static bool withinRounding(const TlsSums &found, const TlsSums &exact, double rounding) {
    const double bound = rounding + 1e-8;
    return found.n == exact.n && std::abs(found.xx - exact.xx) <= bound &&
           std::abs(found.xy - exact.xy) <= bound && std::abs(found.yy - exact.yy) <= bound;
}

template <typename Scalar>
static FtlsVectorizer<Scalar> ftls(simd::Level level, double sigma) {
    FtlsVectorizer<Scalar> vectorize;
    vectorize.level = level;
    vectorize.settings.polyline = false;
    vectorize.settings.sigma = sigma;
    return vectorize;
}

template <typename Scalar>
static void checkIntervals(simd::Level level) {
    int ends = 0, notLongest = 0;
    for (unsigned seed = 1; seed <= 1500; ++seed) {
        std::mt19937 random(seed);
        const auto points = randomCluster<Scalar>(random);
        const double sigma = 0.002 + 0.05 * double(random() % 1000) / 1000;
        auto vectorize = ftls<Scalar>(level, sigma);
        const auto lines = vectorize(PointSpan<Scalar>(points));
        const auto variance = [&](std::size_t first, std::size_t last) {
            return fitLine(exactSums(points, first, last + 1)).variance / (sigma * sigma);
        };
        int meeting = 0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const VectorizedLine &line = lines[i];
            // Three points alone, or two beside a single one, are one line whatever sigma says.
            QVERIFY2(variance(line.first, line.last) <= 1 + 1e-9 || line.sums.n == 3,
                     saying("seed %1: points %2 .. %3", seed, line.first, line.last));
            QVERIFY(line.first == (i == 0 ? 0 : lines[i - 1].last + 1) && line.last > line.first);
            if (i + 1 == lines.size())
                continue;
            // From one end or the other the interval would not fit with one point more; but for the place
            // where the searches from both ends meet. Within what float sums tell.
            const bool ahead = variance(line.first, line.last + 1) > 1 - 0.02;
            const bool back = variance(lines[i + 1].first - 1, lines[i + 1].last) > 1 - 0.02;
            meeting += !ahead && !back;
            ++ends;
        }
        notLongest += meeting > 1;
    }
    QVERIFY(ends > 10000);
    QVERIFY2(notLongest <= 3, saying(notLongest)); // where a single point broke up a neighbour
}

class TestBlockSums : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void theTwinGivesTheSameBits() {
        std::mt19937 random(1);
        for (int i = 0; i < 300; ++i) {
            const auto points = randomCluster<float>(random);
            BlockSums scalar, best;
            scalar.level = simd::Level::Scalar;
            scalar.assign(points);
            best.assign(points);
            QCOMPARE(best.stride(), points.size() <= best.smallCluster ? std::size_t(1) : BlockSums::block);
            QCOMPARE(scalar.lastRow(), best.lastRow());
            for (std::ptrdiff_t b = 0; b <= best.lastRow(); ++b) {
                const SumRow s = scalar.table().row(b), v = best.table().row(b);
                QVERIFY(s.x == v.x && s.y == v.y && s.xx == v.xx && s.yy == v.yy && s.xy == v.xy);
            }
            QCOMPARE(scalar.localError(0, points.size()), best.localError(0, points.size()));
        }
    }

    // NEON of ARMv7 takes a denormal float for 0: at most 1.2e-38 for each point and operation.
    void denormalNumbersMayBeLost() {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> u(-1, 1);
        std::vector<Vector2D<float>> points;
        for (int i = 0; i < 2000; ++i)
            points.emplace_back(u(random) * (i % 2 ? 1e-19f : 1e-38f), u(random) * 1e-19f);
        BlockSums scalar, best;
        scalar.level = simd::Level::Scalar;
        scalar.assign(points);
        best.assign(points);
        const SumRow s = scalar.row(points.size()), v = best.row(points.size());
        const double bound = 2 * 1.2e-38 * double(points.size());
        QVERIFY(std::abs(s.x - v.x) <= bound && std::abs(s.y - v.y) <= bound);
        QVERIFY(std::abs(s.xx - v.xx) <= bound && std::abs(s.yy - v.yy) <= bound);
        QVERIFY(std::abs(s.xy - v.xy) <= bound);
        QVERIFY(v.xx > 0 && v.yy > 0);
    }

    void anyInterval() {
        std::mt19937 random(2);
        for (int i = 0; i < 2000; ++i) {
            const auto points = randomCluster<float>(random);
            BlockSums blocks;
            PrefixSums plain;
            blocks.assign(points);
            plain.assign(PointSpan<float>(points));
            const std::size_t first = random() % points.size(),
                              end = first + 1 + random() % (points.size() - first);
            const TlsSums exact = exactSums(points, first, end);
            QVERIFY(withinRounding(blocks.sums(first, end), exact, blocks.rounding(first, end)));
            QVERIFY(blocks.rounding(first, end) < 1e-4 * (exact.xx + exact.yy) + 1e-2);
            if (end > first + 2)
                QCOMPARE(blocks.fitWithin(first, end, 1e-4), plain.fitWithin(first, end, 1e-4));
        }
    }

    // However many points are behind the last full block.
    void theLastRowIsOfAllPoints() {
        std::mt19937 random(4);
        for (const simd::Level level : {simd::Level::Scalar, simd::bestLevel()}) {
            for (std::size_t count = 640; count <= 640 + BlockSums::block; ++count) {
                std::vector<Vector2D<float>> points;
                for (std::size_t i = 0; i < count; ++i)
                    points.emplace_back(0.02f * float(i), float(random() % 1000) / 1000);
                BlockSums sums;
                sums.level = level;
                sums.assign(points);
                const SumRow &last = sums.table().row(sums.lastRow());
                QVERIFY2(withinRounding(sums.tls(0, count, last), exactSums(points, 0, count),
                                        sums.rounding(0, count)),
                         saying("%1 points", count));
            }
        }
    }

    // A threshold that is the very variance of the points, and a hair more and less: exact sums decide.
    void edgeOfTheThreshold() {
        std::mt19937 random(3);
        std::normal_distribution<float> noise(0, 0.01f);
        for (int run = 0; run < 200; ++run) {
            std::vector<Vector2D<float>> points;
            for (int i = 0; i < 640; ++i)
                points.emplace_back(0.02f * float(i), 2 + noise(random));
            BlockSums sums;
            sums.assign(points);
            const double variance = fitLine(TlsSums::of(points.begin(), points.end())).variance;
            QVERIFY(sums.fitWithin(0, points.size(), variance * (1 + 1e-9)));
            QVERIFY(!sums.fitWithin(0, points.size(), variance * (1 - 1e-9)));
        }
    }

    void intervalsFitAndAreLongest_data() {
        const Rows<int> row("level");
        row("scalar", int(simd::Level::Scalar));
        row("best of this processor", int(simd::bestLevel()));
    }

    void intervalsFitAndAreLongest() {
        QFETCH(int, level);
        checkIntervals<float>(simd::Level(level));
    }

    void doublesToo() { checkIntervals<double>(simd::bestLevel()); }

    // AVX2 adds up the block in which an interval ends in another order: a point of which float sums do not
    // tell may then go to the neighbour.
    void everyLevelFindsTheSameLines() {
        int different = 0;
        for (unsigned seed = 1; seed <= 3000; ++seed) {
            std::mt19937 random(seed);
            const auto points = randomCluster<float>(random);
            const double sigma = 0.002 + 0.05 * double(random() % 1000) / 1000;
            auto scalar = ftls<float>(simd::Level::Scalar, sigma),
                 best = ftls<float>(simd::bestLevel(), sigma);
            const auto &expected = scalar(points), &lines = best(points);
            bool same = lines.size() == expected.size();
            for (std::size_t i = 0; same && i < lines.size(); ++i)
                same = lines[i].first == expected[i].first && lines[i].last == expected[i].last;
            different += !same;
            for (std::size_t i = 0; same && i < lines.size(); ++i) {
                const std::size_t first = lines[i].first, end = lines[i].last + 1;
                const TlsSums exact = exactSums(points, first, end);
                // The rows of its ends may have been reached from within the blocks beside it.
                const BlockSums &sums = best.intervals().search.sums();
                const double beside = sums.localError(first - std::min(first, BlockSums::block),
                                                      std::min(end + BlockSums::block, points.size()));
                const double bound = sums.rounding(first, end) + beside;
                QVERIFY(withinRounding(lines[i].sums, exact, bound) &&
                        withinRounding(expected[i].sums, exact, bound));
            }
        }
        const int allowed = simd::bestLevel() == simd::Level::Avx2 ? 3 : 0;
        QVERIFY2(different <= allowed, saying("%1 of 3000", different));
    }

    // In small clusters every point has a row: no level may tell otherwise, not even where rounding alone
    // tells whether points on a line fit.
    void smallClustersAreTheSameWhateverIsRounded() {
        for (unsigned seed = 1; seed <= 3000; ++seed) {
            std::mt19937 random(seed);
            std::vector<Vector2D<float>> points{{1, 2}};
            float dx = 0, dy = 0;
            while (points.size() < 20 + seed % 200) {
                if (random() % 16 == 0 || dx == 0) {
                    dx = 0.01f * float(1 + random() % 9);
                    dy = 0.01f * float(random() % 9);
                }
                points.push_back({points.back().x + dx, points.back().y + dy});
            }
            const double sigma = 1e-7 * double(random() % 4);
            auto scalar = ftls<float>(simd::Level::Scalar, sigma),
                 best = ftls<float>(simd::bestLevel(), sigma);
            const auto &expected = scalar(points), &lines = best(points);
            QCOMPARE(lines.size(), expected.size());
            for (std::size_t i = 0; i < lines.size(); ++i)
                QVERIFY2(lines[i].last == expected[i].last && lines[i].sigma == expected[i].sigma,
                         saying("seed %1, line %2", seed, i));
        }
    }

    // Lines are made four at a time, with the results of one at a time.
    void linesAreThoseOfMakeLine() {
#if defined(VECTORLIB_SIMD_AVX2)
        if (simd::bestLevel() != simd::Level::Avx2)
            QSKIP("this processor has no AVX2");
        for (unsigned seed = 1; seed <= 300; ++seed) {
            std::mt19937 random(seed);
            const auto points = randomCluster<float>(random);
            FtlsIntervals<float> intervals;
            const auto &cuts = intervals(PointSpan<float>(points), 1e-4);
            std::vector<VectorizedLine> expected, lines;
            makeLines(PointSpan<float>(points), intervals.search.origin(), cuts, expected);
            makeLinesAvx2(points, intervals.search.origin(), cuts, lines);
            QCOMPARE(lines.size(), expected.size());
            for (std::size_t i = 0; i < lines.size(); ++i) {
                const VectorizedLine &a = lines[i], &b = expected[i];
                QVERIFY(a.first == b.first && a.last == b.last && a.sigma == b.sigma &&
                        a.sums.mean == b.sums.mean);
                QVERIFY(a.sums.xx == b.sums.xx && a.sums.xy == b.sums.xy && a.sums.yy == b.sums.yy);
                QVERIFY(a.line.a == b.line.a && a.line.b == b.line.b && a.line.c == b.line.c);
                QVERIFY(a.segment.begin() == b.segment.begin() && a.segment.end() == b.segment.end());
                QVERIFY(a.segment.direction() == b.segment.direction());
            }
        }
#else
        QSKIP("four lines at a time need AVX2");
#endif
    }

    void aftlsOfEveryLevel() {
        for (unsigned seed = 1; seed <= 500; ++seed) {
            std::mt19937 random(seed);
            const auto points = randomCluster<float>(random);
            AftlsVectorizer<float> scalar, best;
            scalar.level = simd::Level::Scalar;
            scalar.settings.polyline = best.settings.polyline = false;
            const auto &expected = scalar(points), &lines = best(points);
            QCOMPARE(lines.size(), expected.size());
            double squares = 0, expectedSquares = 0;
            for (std::size_t i = 0; i < lines.size(); ++i) {
                squares += sumOfSquares(exactSums(points, lines[i].first, lines[i].last + 1));
                expectedSquares += sumOfSquares(exactSums(points, expected[i].first, expected[i].last + 1));
            }
            QVERIFY(std::abs(squares - expectedSquares) <= 1e-3 * expectedSquares + 1e-9);
        }
    }

    // Where a part of an interval that fits does not fit itself, both directions may go on differently: where
    // the noise comes near sigma.
    void sameIntervalsInReverse() {
        int different = 0;
        for (unsigned seed = 1; seed <= 1500; ++seed) {
            std::mt19937 random(seed);
            auto points = randomCluster<double>(random);
            auto vectorize = ftls<double>(simd::bestLevel(), 0.002 + 0.05 * double(random() % 1000) / 1000);
            const auto lines = vectorize(PointSpan<double>(points));
            std::reverse(points.begin(), points.end());
            const auto &reversed = vectorize(PointSpan<double>(points));
            bool same = reversed.size() == lines.size();
            for (std::size_t i = 0; same && i < lines.size(); ++i)
                same = reversed[lines.size() - 1 - i].first == points.size() - 1 - lines[i].last;
            different += !same;
        }
        QVERIFY2(different <= 75, saying("%1 of 1500", different));
    }

    // A point far away in the middle of a block spoils the float sums of the whole block: exact sums find it.
    void aWildPointCostsTimeOnly() {
        std::mt19937 random(4);
        std::normal_distribution<float> noise(0, 0.005f);
        for (int run = 0; run < 50; ++run) {
            std::vector<Vector2D<float>> points;
            for (int i = 0; i < 2000; ++i)
                points.emplace_back(0.01f * float(i), 2 + noise(random));
            points[random() % points.size()] = {5000, -7000};
            auto vectorize = ftls<float>(simd::bestLevel(), 0.02);
            for (const VectorizedLine &line : vectorize(points)) {
                const double variance = fitLine(exactSums(points, line.first, line.last + 1)).variance;
                QVERIFY(variance <= 4e-4 * (1 + 1e-9));
                QVERIFY(std::abs(line.sigma * line.sigma - variance) < 1e-5);
            }
        }
    }

    // All but the last point fit: the search must not read on behind the table. For the sanitizers, too.
    void wildPointsAtTheEnds() {
        for (const auto level : {simd::Level::Scalar, simd::bestLevel()})
            for (std::size_t count = 4; count < 700; count += count < 80 ? 1 : 7) {
                std::vector<Vector2D<float>> points;
                for (std::size_t i = 0; i < count; ++i)
                    points.emplace_back(0.02f * float(i), 2.0f);
                points.front() = {-3, -40};
                points.back() = {50, -40};
                auto vectorize = ftls<float>(level, 0.02);
                const auto &lines = vectorize(points);
                QVERIFY(lines.size() >= 2 && lines.front().first == 0 && lines.back().last == count - 1);
            }
    }
};
