#include <vectorlib/segmentation/EarSegmenter.h>

#include <type_traits>

using namespace vectorlib;

/// The algorithm of thesis 5.2 as it is written: every point against all its K predecessors, labels rewritten
/// at each merge.
struct Reference {
    std::vector<int> labels, order;

    /// `near(i, j)`: for points that take part; `gap(i, j)` compares distances.
    template <typename Near, typename Gap>
    Reference(std::size_t count, const std::vector<int> &valid, const EarSettings &s, Near near, Gap gap) {
        const int n = int(valid.size());
        std::vector<int> cluster(valid.size());
        const auto merge = [&](int a, int b) {
            const int from = std::max(cluster[a], cluster[b]), to = std::min(cluster[a], cluster[b]);
            std::replace(cluster.begin(), cluster.end(), from, to);
        };
        for (int i = 0; i < n; ++i) {
            cluster[i] = i;
            for (int back = 1; back <= s.neighbours && back <= i; ++back)
                if (near(valid[i], valid[i - back]))
                    merge(i, i - back);
        }
        for (int i = 0; s.closed && i < std::min(s.neighbours, n); ++i)
            for (int back = i + 1; back <= s.neighbours && back < n; ++back)
                if (near(valid[i], valid[n + i - back]))
                    merge(i, n + i - back);
        labels.assign(count, -1);
        int next = 0;
        for (int c = 0; c < n; ++c) {
            std::vector<int> members;
            for (int i = 0; i < n; ++i)
                if (cluster[i] == c)
                    members.push_back(i);
            if (members.empty() || int(members.size()) < s.minPoints)
                continue;
            const int reach = std::min(s.neighbours, n);
            if (s.closed && members.front() < reach && members.back() >= n - reach) {
                std::size_t start = 0;
                auto widest = gap(valid[members.front()], valid[members.back()]);
                for (std::size_t i = 1; i < members.size(); ++i)
                    if (const auto g = gap(valid[members[i]], valid[members[i - 1]]); g > widest) {
                        widest = g;
                        start = i;
                    }
                std::rotate(members.begin(), members.begin() + std::ptrdiff_t(start), members.end());
            }
            for (int i : members) {
                labels[valid[i]] = next;
                order.push_back(valid[i]);
            }
            ++next;
        }
    }
};

/// Ranges of a made-up scan: walls that jump, noise, stray points, invalid ranges.
static std::vector<float> randomRanges(std::mt19937 &random, std::size_t count) {
    std::uniform_real_distribution<float> u(0, 1);
    std::normal_distribution<float> noise(0, 0.01f);
    const float stray = u(random) < 0.3f ? 0.3f : 0.03f, jump = u(random) * 0.05f,
                invalid = u(random) < 0.5f ? 0 : 0.05f;
    const float none[] = {0, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -1, 40};
    std::vector<float> ranges;
    float wall = 2;
    for (std::size_t i = 0; i < count; ++i) {
        if (u(random) < jump)
            wall = 0.3f + 6 * u(random) * u(random);
        wall = std::max(0.2f, wall * (1 + 0.02f * (u(random) - 0.5f)));
        float r = wall + noise(random);
        if (u(random) < stray)
            r += (u(random) - 0.3f) * 1.5f;
        if (u(random) < invalid)
            r = none[random() % 5];
        ranges.push_back(r);
    }
    return ranges;
}

static EarSettings randomSettings(std::mt19937 &random, std::size_t count) {
    EarSettings s;
    s.neighbours = 1 + int(random() % (random() % 4 ? 15 : 80));
    s.closed = random() % 2;
    s.fieldOfView = s.closed ? 2 * pi : 0.5 + double(random() % 100) / 20;
    s.minPoints = 1 + int(random() % 15);
    s.nominalPoints = random() % 2 ? count : 0;
    return s;
}

static void levels() {
    const Rows<int> row("level");
    row("scalar", int(simd::Level::Scalar));
    row("best of this processor", int(simd::bestLevel()));
}

static void compare(const Segmentation &found, const Reference &expected, unsigned seed) {
    QVERIFY2(found.labels == expected.labels, saying("seed %1", seed));
    QVERIFY2(found.order == expected.order, saying("seed %1", seed));
}

template <typename Scalar>
static void compareCartesian(simd::Level level) {
    EarSegmenter<Scalar> segment;
    segment.level = level;
    for (unsigned seed = 1; seed <= 600 && !QTest::currentTestFailed(); ++seed) {
        std::mt19937 random(seed);
        const std::size_t count = random() % 400;
        const std::vector<float> ranges = randomRanges(random, count);
        segment.settings = randomSettings(random, count);
        const EarSettings &s = segment.settings;
        std::vector<Vector2D<Scalar>> points;
        std::vector<int> valid;
        for (std::size_t i = 0; i < count; ++i) {
            const double a = s.fieldOfView * double(i) / double(count);
            points.emplace_back(Scalar(ranges[i]) * Scalar(std::cos(a)),
                                Scalar(ranges[i]) * Scalar(std::sin(a)));
            if (points.back().isFinite())
                valid.push_back(int(i));
        }
        const double k = count ? s.neighbours * s.fieldOfView / double(count) : 0;
        const auto gap = [&](int i, int j) { return (points[i] - points[j]).squaredNorm(); };
        const auto near = [&](int i, int j) {
            const Scalar limit =
                std::clamp(Scalar(k * k) * points[i].squaredNorm(), Scalar(s.minThreshold * s.minThreshold),
                           Scalar(s.maxThreshold * s.maxThreshold));
            return gap(i, j) <= limit;
        };
        compare(segment(points), Reference(count, valid, s, near, gap), seed);
    }
}

/// `scale`: metres in a unit of the ranges, which are rounded to whole units where these are integers.
template <typename Range>
static void comparePolar(simd::Level level, double scale) {
    EarSegmenter<float> segment;
    segment.level = level;
    for (unsigned seed = 1; seed <= 600 && !QTest::currentTestFailed(); ++seed) {
        std::mt19937 random(seed);
        const std::size_t count = random() % 400;
        std::vector<Range> units;
        std::vector<float> ranges;
        for (const float r : randomRanges(random, count)) {
            const bool none = std::is_integral_v<Range> && !(r > 0 && r < 60);
            units.push_back(none ? Range(0) : Range(r / scale));
            ranges.push_back(float(double(units.back()) * scale));
        }
        segment.settings = randomSettings(random, count);
        const EarSettings &s = segment.settings;
        const double step = s.fieldOfView / double(count + 1);
        std::vector<int> valid;
        for (std::size_t i = 0; i < count; ++i)
            if (const double metres = double(units[i]) * scale; metres >= 0.1 && metres < 30)
                valid.push_back(int(i));
        const float k = count ? float(s.neighbours * s.fieldOfView / double(count)) : 0;
        const auto rays = [&](int i, int j) {
            const int d = std::abs(i - j);
            return s.closed ? std::min(d, int(count) - d) : d;
        };
        const auto gap = [&](int i, int j) {
            const double dr = ranges[i] - ranges[j], arc = ranges[i] * (rays(i, j) * step);
            return dr * dr + arc * arc;
        };
        const auto near = [&](int i, int j) {
            const float limit = std::clamp(k * ranges[i], float(s.minThreshold), float(s.maxThreshold));
            return rays(i, j) <= s.neighbours && std::abs(ranges[i] - ranges[j]) <= limit;
        };
        const PolarScan<Range> scan{units.data(), count, 0, step, scale, 0.1, 30};
        compare(segment(scan), Reference(count, valid, s, near, gap), seed);
    }
}

class TestSegmentationExact : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void cartesianEqualsTheFullAlgorithm_data() { levels(); }

    void cartesianEqualsTheFullAlgorithm() {
        QFETCH(int, level);
        compareCartesian<float>(simd::Level(level));
        compareCartesian<double>(simd::Level(level));
    }

    void polarEqualsTheFullAlgorithm_data() { levels(); }

    void polarEqualsTheFullAlgorithm() {
        QFETCH(int, level);
        comparePolar<float>(simd::Level(level), 1);
        comparePolar<double>(simd::Level(level), 1);
        comparePolar<std::uint16_t>(simd::Level(level), 0.001);
        comparePolar<std::uint32_t>(simd::Level(level), 0.0001);
    }

    void polarFindsWhatCartesianFinds() {
        const std::size_t count = 1000;
        std::vector<float> ranges;
        for (std::size_t i = 0; i < count; ++i) // two half circles and a stray ray every 50
            ranges.push_back((i < count / 2 ? 2.0f : 3.0f) * (i % 50 == 25 ? 0.5f : 1.0f));
        const PolarScan<float> scan{ranges.data(), count, 0, 2 * pi / double(count)};
        std::vector<Vector2D<float>> points;
        for (std::size_t i = 0; i < count; ++i)
            points.emplace_back(scan.point(i));
        EarSegmenter<float> cartesian, polar;
        QVERIFY(cartesian(points).labels == polar(scan).labels);
        QCOMPARE(polar(scan).size(), std::size_t(2));
    }

    void longScansAtAllLevels() {
        std::mt19937 random(7);
        const std::size_t count = 50000;
        const std::vector<float> ranges = randomRanges(random, count);
        const PolarScan<float> scan{ranges.data(), count, 0, 2 * pi / double(count), 1, 0.1, 30};
        std::vector<Vector2D<float>> points;
        for (std::size_t i = 0; i < count; ++i)
            points.emplace_back(scan.point(i));
        EarSegmenter<float> plain, best;
        plain.level = simd::Level::Scalar;
        QVERIFY(plain(points).size() > 10);
        QVERIFY(plain(points).labels == best(points).labels);
        QVERIFY(plain(points).order == best(points).order);
        QVERIFY(plain(scan).size() > 10);
        QVERIFY(plain(scan).labels == best(scan).labels);
        QVERIFY(plain(scan).order == best(scan).order);
    }

    // Three walls whose points alternate all around: each cluster runs over the end and has its own widest
    // gap.
    void manyClustersOverTheEnd() {
        std::vector<float> ranges;
        for (int i = 0; i < 999; ++i)
            ranges.push_back(float(1 + i % 3));
        for (int i = 600; i < 612; ++i) // a gap in every wall
            ranges[std::size_t(i)] = 0;
        const PolarScan<float> scan{ranges.data(), ranges.size(), 0, 2 * pi / 999};
        EarSegmenter<float> segment;
        segment.settings.neighbours = 20;
        for (const simd::Level level : {simd::Level::Scalar, simd::bestLevel()}) {
            segment.level = level;
            const Segmentation &s = segment(scan);
            QCOMPARE(s.size(), std::size_t(3));
            for (std::size_t c = 0; c < 3; ++c) {
                QCOMPARE(s.size(c), std::size_t(329));
                QCOMPARE(s.order[s.starts[c]], 612 + int(c));
                QCOMPARE(s.order[s.starts[c + 1] - 1], 597 + int(c));
            }
        }
    }

    // The range grows by one part in a million from ray to ray up to ray 500, and falls again.
    void gapsThatHardlyDiffer() {
        std::vector<float> ranges;
        for (int i = 0; i < 1000; ++i)
            ranges.push_back(float(2 - 2e-6 * std::abs(i - 500)));
        const PolarScan<float> scan{ranges.data(), ranges.size(), 0, 2 * pi / 1000};
        EarSegmenter<float> segment;
        for (const simd::Level level : {simd::Level::Scalar, simd::bestLevel()}) {
            segment.level = level;
            QCOMPARE(segment(scan).order.front(), 500);
            QCOMPARE(segment(scan).size(0), ranges.size());
        }
    }
};
