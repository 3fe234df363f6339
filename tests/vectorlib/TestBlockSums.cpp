#include <vectorlib/vectorization/FtlsVectorizer.h>

#include <QtTest>

#include <cstring>
#include <random>

using namespace vectorlib;

namespace {

/// A random chain of lines with noise; some with stray points, some far from the origin.
template <typename Scalar>
std::vector<Vector2D<Scalar>> randomCluster(std::mt19937 &random) {
    std::uniform_real_distribution<double> u(0, 1);
    const std::size_t count = 2 + random() % (random() % 4 ? 400 : 3000);
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

/// The search of FtlsVectorizer over prefix sums of every point in double.
template <typename Scalar>
std::vector<std::size_t> plainCuts(PointSpan<Scalar> points, double variance) {
    PrefixSums sums;
    sums.assign(points);
    const std::size_t count = points.size(), block = BlockSums<Scalar>::block;
    const auto fit = [&](std::size_t first, std::size_t end) {
        return end <= first + 2 || sums.fitWithin(first, end, variance);
    };
    const auto halve = [&](std::size_t first, std::size_t begin, std::size_t good, std::size_t bad,
                           std::size_t unit) {
        while (bad - good > 1) {
            const std::size_t middle = (good + bad) / 2;
            (fit(first, begin + middle * unit) ? good : bad) = middle;
        }
        return good;
    };
    std::vector<std::size_t> cuts{0};
    while (cuts.back() < count) {
        const std::size_t first = cuts.back();
        if (fit(first, count)) {
            cuts.push_back(count);
            break;
        }
        const std::size_t b = halve(first, 0, first / block, (count + block - 1) / block, block);
        const std::size_t end = std::min(count, (b + 1) * block);
        std::size_t begin = std::max(first, b * block);
        while (fit(first, std::min(begin + 8, end)))
            begin += 8;
        cuts.push_back(begin + halve(first, begin, 0, std::min<std::size_t>(8, end - begin), 1));
    }
    return cuts;
}

bool withinRounding(const TlsSums &found, const TlsSums &exact, double rounding) {
    const double bound = rounding + 1e-8;
    return found.n == exact.n && std::abs(found.xx - exact.xx) <= bound &&
           std::abs(found.xy - exact.xy) <= bound && std::abs(found.yy - exact.yy) <= bound;
}

template <typename Scalar>
void compareWithPlain(simd::Level level) {
    for (unsigned seed = 1; seed <= 1500; ++seed) {
        std::mt19937 random(seed);
        const auto points = randomCluster<Scalar>(random);
        FtlsVectorizer<Scalar> vectorize;
        vectorize.level(level);
        vectorize.settings.polyline = false;
        vectorize.settings.sigma = 0.002 + 0.05 * double(random() % 1000) / 1000;
        const double sigma = vectorize.settings.sigma;
        const auto cuts = plainCuts(PointSpan<Scalar>(points), sigma * sigma);
        const auto &lines = vectorize(points);
        // A single last point is moved to the line before: intervals are compared up to there.
        for (std::size_t i = 0; i + 2 < lines.size(); ++i)
            QVERIFY2(lines[i].first == cuts[i] && lines[i].last + 1 == cuts[i + 1],
                     qPrintable(QString("seed %1, line %2").arg(seed).arg(i)));
        for (const VectorizedLine &line : lines) {
            const TlsSums exact = TlsSums::of(points.begin() + std::ptrdiff_t(line.first),
                                              points.begin() + std::ptrdiff_t(line.last) + 1);
            QVERIFY(withinRounding(line.sums, exact, vectorize.sums().rounding(line.first, line.last + 1)));
            // A last point alone joins a line of two, or takes a point from the line before, whatever sigma
            // says.
            QVERIFY2(&line + 2 >= lines.data() + lines.size() || line.sigma <= sigma * (1 + 1e-9),
                     qPrintable(QString("seed %1: points %2 .. %3, sigma %4 of %5")
                                    .arg(seed)
                                    .arg(line.first)
                                    .arg(line.last)
                                    .arg(line.sigma, 0, 'g', 17)
                                    .arg(sigma, 0, 'g', 17)));
        }
    }
}

} // namespace

class TestBlockSums : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void intervalsAreThoseOfExactSums_data();
    void intervalsAreThoseOfExactSums();
    void doublesToo();
    void theTwinGivesTheSameBits();
    void anyInterval();
    void edgeOfTheThreshold();
};

void TestBlockSums::intervalsAreThoseOfExactSums_data() {
    QTest::addColumn<int>("level");
    QTest::newRow("scalar") << int(simd::Level::Scalar);
    QTest::newRow("best of this processor") << int(simd::bestLevel());
}

void TestBlockSums::intervalsAreThoseOfExactSums() {
    QFETCH(int, level);
    compareWithPlain<float>(simd::Level(level));
}

void TestBlockSums::doublesToo() {
    compareWithPlain<double>(simd::bestLevel());
}

void TestBlockSums::theTwinGivesTheSameBits() {
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        const auto points = randomCluster<float>(random);
        BlockSums<float> scalar, best;
        scalar.level = simd::Level::Scalar;
        scalar.assign(points);
        best.assign(points);
        for (std::size_t b = 0; b <= best.blocks(); ++b) {
            const auto s = scalar.atBorder(b), v = best.atBorder(b);
            QVERIFY(std::memcmp(&s.row, &v.row, sizeof s.row) == 0);
            QCOMPARE(s.error, v.error);
        }
    }
}

void TestBlockSums::anyInterval() {
    std::mt19937 random(2);
    for (int i = 0; i < 2000; ++i) {
        const auto points = randomCluster<float>(random);
        BlockSums<float> blocks;
        PrefixSums plain;
        blocks.assign(points);
        plain.assign(PointSpan<float>(points));
        const std::size_t first = random() % points.size(),
                          end = first + 1 + random() % (points.size() - first);
        const TlsSums exact =
            TlsSums::of(points.begin() + std::ptrdiff_t(first), points.begin() + std::ptrdiff_t(end));
        QVERIFY(withinRounding(blocks.sums(first, end), exact, blocks.rounding(first, end)));
        QVERIFY(blocks.rounding(first, end) < 1e-4 * (exact.xx + exact.yy) + 1e-2);
        if (end > first + 2)
            QCOMPARE(blocks.fitWithin(first, end, 1e-4), plain.fitWithin(first, end, 1e-4));
    }
}

// A threshold that is the very variance of the points, and a hair more and less: exact sums decide.
void TestBlockSums::edgeOfTheThreshold() {
    std::mt19937 random(3);
    std::normal_distribution<float> noise(0, 0.01f);
    for (int run = 0; run < 200; ++run) {
        std::vector<Vector2D<float>> points;
        for (int i = 0; i < 320; ++i)
            points.emplace_back(0.02f * float(i), 2 + noise(random));
        BlockSums<float> sums;
        sums.assign(points);
        const double variance = fitLine(TlsSums::of(points.begin(), points.end())).variance;
        QVERIFY(sums.fitWithin(0, points.size(), variance * (1 + 1e-9)));
        QVERIFY(!sums.fitWithin(0, points.size(), variance * (1 - 1e-9)));
    }
}

QTEST_APPLESS_MAIN(TestBlockSums)
#include "TestBlockSums.moc"
