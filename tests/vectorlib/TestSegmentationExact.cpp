#include <vectorlib/segmentation/EarSegmenter.h>

#include <QtTest>

#include <limits>
#include <random>

using namespace vectorlib;

namespace {

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
std::vector<float> randomRanges(std::mt19937 &random, std::size_t count) {
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

EarSettings randomSettings(std::mt19937 &random, std::size_t count) {
    EarSettings s;
    s.neighbours = 1 + int(random() % 15);
    s.closed = random() % 2;
    s.fieldOfView = s.closed ? 2 * pi : 0.5 + double(random() % 100) / 20;
    s.minPoints = 1 + int(random() % 15);
    s.nominalPoints = random() % 2 ? count : 0;
    return s;
}

} // namespace

class TestSegmentationExact : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void cartesianEqualsTheFullAlgorithm_data();
    void cartesianEqualsTheFullAlgorithm();
    void polarEqualsTheFullAlgorithm();
    void polarTakesIntegers();
    void polarFindsWhatCartesianFinds();
    void longScanInDoubles();
};

void TestSegmentationExact::cartesianEqualsTheFullAlgorithm_data() {
    QTest::addColumn<int>("level");
    QTest::newRow("scalar") << int(simd::Level::Scalar);
    QTest::newRow("best of this processor") << int(simd::bestLevel());
}

void TestSegmentationExact::cartesianEqualsTheFullAlgorithm() {
    QFETCH(int, level);
    EarSegmenter<float> segment;
    segment.level = simd::Level(level);
    for (unsigned seed = 1; seed <= 600; ++seed) {
        std::mt19937 random(seed);
        const std::size_t count = random() % 400;
        const std::vector<float> ranges = randomRanges(random, count);
        segment.settings = randomSettings(random, count);
        const EarSettings &s = segment.settings;
        std::vector<Vector2D<float>> points;
        std::vector<int> valid;
        for (std::size_t i = 0; i < count; ++i) {
            const double a = s.fieldOfView * double(i) / double(count);
            points.emplace_back(ranges[i] * float(std::cos(a)), ranges[i] * float(std::sin(a)));
            if (points.back().isFinite())
                valid.push_back(int(i));
        }
        const double k = count ? s.neighbours * s.fieldOfView / double(count) : 0;
        const auto gap = [&](int i, int j) { return (points[i] - points[j]).squaredNorm(); };
        const auto near = [&](int i, int j) {
            const float limit =
                std::clamp(float(k * k) * points[i].squaredNorm(), float(s.minThreshold * s.minThreshold),
                           float(s.maxThreshold * s.maxThreshold));
            return gap(i, j) <= limit;
        };
        const Reference expected(count, valid, s, near, gap);
        const Segmentation &found = segment(points);
        QVERIFY2(found.labels == expected.labels, qPrintable(QString("seed %1").arg(seed)));
        QVERIFY2(found.order == expected.order, qPrintable(QString("seed %1").arg(seed)));
    }
}

void TestSegmentationExact::polarEqualsTheFullAlgorithm() {
    EarSegmenter<float> segment;
    for (unsigned seed = 1; seed <= 600; ++seed) {
        std::mt19937 random(seed);
        const std::size_t count = random() % 400;
        const std::vector<float> ranges = randomRanges(random, count);
        segment.settings = randomSettings(random, count);
        const EarSettings &s = segment.settings;
        const PolarScan<float> scan{ranges.data(), count, 0, s.fieldOfView / double(count + 1), 1, 0.1, 30};
        std::vector<int> valid;
        for (std::size_t i = 0; i < count; ++i)
            if (ranges[i] >= 0.1f && ranges[i] < 30)
                valid.push_back(int(i));
        const float k = count ? float(s.neighbours * s.fieldOfView / double(count)) : 0;
        const auto rays = [&](int i, int j) {
            const int d = std::abs(i - j);
            return s.closed ? std::min(d, int(count) - d) : d;
        };
        const auto gap = [&](int i, int j) {
            const double dr = ranges[i] - ranges[j], arc = ranges[i] * (rays(i, j) * scan.step);
            return dr * dr + arc * arc;
        };
        const auto near = [&](int i, int j) {
            const float limit = std::clamp(k * ranges[i], float(s.minThreshold), float(s.maxThreshold));
            return rays(i, j) <= s.neighbours && std::abs(ranges[i] - ranges[j]) <= limit;
        };
        const Reference expected(count, valid, s, near, gap);
        const Segmentation &found = segment(scan);
        QVERIFY2(found.labels == expected.labels, qPrintable(QString("seed %1").arg(seed)));
        QVERIFY2(found.order == expected.order, qPrintable(QString("seed %1").arg(seed)));
    }
}

void TestSegmentationExact::polarTakesIntegers() {
    std::vector<std::uint16_t> millimetres(720, 2000);
    std::fill(millimetres.begin() + 360, millimetres.end(), std::uint16_t(4000));
    millimetres[100] = 0;     // no return
    millimetres[101] = 65535; // over range
    EarSegmenter<float> segment;
    segment.settings.minThreshold = 0.1;
    const Segmentation &s = segment(
        PolarScan<std::uint16_t>{millimetres.data(), millimetres.size(), 0, 2 * pi / 720, 0.001, 0.05, 60});
    QCOMPARE(s.size(), std::size_t(2));
    QCOMPARE(s.size(0), std::size_t(358));
    QCOMPARE(s.labels[100], -1);
    QCOMPARE(s.labels[101], -1);
    QCOMPARE(s.labels[102], 0);
    QCOMPARE(segment(PolarScan<std::uint16_t>()).size(), std::size_t(0));
}

void TestSegmentationExact::polarFindsWhatCartesianFinds() {
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

void TestSegmentationExact::longScanInDoubles() {
    std::vector<Vector2D<double>> points;
    for (int i = 0; i < 50000; ++i)
        points.emplace_back(3 * std::cos(2 * pi * i / 50000), 3 * std::sin(2 * pi * i / 50000));
    EarSegmenter<double> segment;
    QCOMPARE(segment(points).size(), std::size_t(1));
    QCOMPARE(segment(points).size(0), points.size());
}

QTEST_APPLESS_MAIN(TestSegmentationExact)
#include "TestSegmentationExact.moc"
