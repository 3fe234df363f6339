#include <vectorlib/edges/EdgeExtractor.h>

using namespace vectorlib;
using Points = std::vector<Vector2D<float>>;

static Points arc(double from, double to, int count, double radius) {
    Points points;
    for (int i = 0; i < count; ++i) {
        const double a = from + (to - from) * i / count;
        points.emplace_back(float(radius * std::cos(a)), float(radius * std::sin(a)));
    }
    return points;
}

class TestEarSegmenter : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void splitsAtJumps() {
        Points points = arc(0, pi, 500, 2);
        const Points far = arc(pi, 2 * pi, 500, 4);
        points.insert(points.end(), far.begin(), far.end());
        EarSegmenter<float> segment;
        const Segmentation &s = segment(points);
        QCOMPARE(s.size(), std::size_t(2));
        QCOMPARE(s.size(0), std::size_t(500));
        QCOMPARE(s.labels.front(), 0);
        QCOMPARE(s.labels.back(), 1);
    }

    void outliersDoNotBreakACluster() {
        Points points = arc(0, 2 * pi, 1000, 2);
        for (std::size_t i = 50; i < 1000; i += 50)
            points[i] = points[i] * 3.0f;
        EarSegmenter<float> segment;
        const Segmentation &s = segment(points);
        QCOMPARE(s.size(), std::size_t(1));
        QCOMPARE(std::count(s.labels.begin(), s.labels.end(), -1), std::ptrdiff_t(19));
    }

    void smallClustersAreOutliers() {
        EarSegmenter<float> segment;
        segment.settings.nominalPoints = 1000;
        QCOMPARE(segment(arc(0, 0.1, 14, 2)).size(), std::size_t(0));
        QCOMPARE(segment(arc(0, 0.1, 15, 2)).size(), std::size_t(1));
    }

    void closesAFullTurn() {
        EarSegmenter<float> segment;
        Points points = arc(-1, 1, 300, 2); // in two halves, begun in the middle
        std::rotate(points.begin(), points.begin() + 150, points.end());
        segment.settings.nominalPoints = 900;
        QCOMPARE(segment(points).size(), std::size_t(1));
        segment.settings.closed = false;
        QCOMPARE(segment(points).size(), std::size_t(2));
    }

    void clusterOverTheEndBeginsAfterItsGap() {
        EarSegmenter<float> segment;
        segment.settings.nominalPoints = 900;
        Points points = arc(-1, 1, 300, 2);
        std::rotate(points.begin(), points.begin() + 100, points.end());
        const Segmentation &s = segment(points);
        QCOMPARE(s.size(), std::size_t(1));
        QCOMPARE(s.order.front(), 200); // where the arc begins
        QCOMPARE(s.order.back(), 199);
    }

    void mergesRetroactively() {
        // Points that jump between two walls, until one point lies near both: thesis figure 5.1, third case.
        Points points;
        for (int i = 0; i < 20; ++i) {
            points.emplace_back(2.0f, 0.01f * float(i));
            points.emplace_back(2.3f, 0.01f * float(i));
        }
        EarSegmenter<float> segment;
        segment.settings.closed = false;
        segment.settings.minThreshold = segment.settings.maxThreshold = 0.2;
        QCOMPARE(segment(points).size(), std::size_t(2));
        points.emplace_back(2.15f, 0.2f);
        QCOMPARE(segment(points).size(), std::size_t(1));
    }

    // Erratum 14: half the field of view halves the threshold for the same number of rays; (5.1) as printed
    // would not.
    void thresholdFollowsTheFieldOfView() {
        EarSegmenter<float> segment;
        segment.settings.closed = false;
        segment.settings.minPoints = 1;
        segment.settings.minThreshold = 0.01;
        segment.settings.maxThreshold = 10;
        segment.settings.nominalPoints = 360;
        const Points gap{{2.0f, 0.0f}, {2.0f, 0.3f}}; // K 2 pi / N r = 0.35, with F = pi 0.17
        QCOMPARE(segment(gap).size(), std::size_t(1));
        segment.settings.fieldOfView = pi;
        QCOMPARE(segment(gap).size(), std::size_t(2));
    }

    void thresholdBounds() {
        EarSegmenter<float> segment;
        segment.settings.closed = false;
        segment.settings.minPoints = 1;
        segment.settings.nominalPoints = 1000;
        const auto clusters = [&](float range, float across) {
            return segment(Points{{range, 0}, {range, across}}).size();
        };
        QCOMPARE(clusters(0.1f, 0.049f), std::size_t(1)); // scaled: 0.006 m
        QCOMPARE(clusters(0.1f, 0.051f), std::size_t(2));
        QCOMPARE(clusters(2, 0.120f), std::size_t(1)); // scaled: 0.126 m
        QCOMPARE(clusters(2, 0.130f), std::size_t(2));
        QCOMPARE(clusters(50, 0.199f), std::size_t(1)); // scaled: 3.1 m
        QCOMPARE(clusters(50, 0.201f), std::size_t(2));
    }

    void closingFollowsTheScanner() {
        QVERIFY(EarSettings::forScanner(2 * pi, 1440).closed);
        QVERIFY(!EarSettings::forScanner(1.5 * pi, 1080).closed);
        QCOMPARE(EarSettings::forScanner(pi, 1000).fieldOfView, double(pi));
        QCOMPARE(EarSettings::forScanner(pi, 1000).nominalPoints, std::size_t(1000));
    }

    // As thresholdFollowsTheFieldOfView and thresholdBounds, for ranges.
    void polarThreshold() {
        EarSegmenter<float> segment;
        segment.settings.closed = false;
        segment.settings.minPoints = 1;
        segment.settings.nominalPoints = 1000;
        const auto clusters = [&](float range, float farther) {
            const float ranges[] = {range, range + farther};
            return segment(PolarScan<float>{ranges, 2, 0, 2 * pi / 1000}).size();
        };
        QCOMPARE(clusters(0.1f, 0.049f), std::size_t(1));
        QCOMPARE(clusters(0.1f, 0.051f), std::size_t(2));
        QCOMPARE(clusters(2, 0.120f), std::size_t(1)); // K 2 pi / N r = 0.13
        QCOMPARE(clusters(2, 0.145f), std::size_t(2));
        QCOMPARE(clusters(50, 0.199f), std::size_t(1));
        QCOMPARE(clusters(50, 0.201f), std::size_t(2));
        segment.settings.fieldOfView = pi;
        QCOMPARE(clusters(2, 0.120f), std::size_t(2)); // K pi / N r = 0.067
        QCOMPARE(clusters(2, 0.060f), std::size_t(1));
    }

    void polarClosesAFullTurn() {
        std::vector<float> ranges(720, 2.0f);
        std::fill(ranges.begin() + 100, ranges.begin() + 600, 0.0f);
        const PolarScan<float> scan{ranges.data(), ranges.size(), 0, 2 * pi / 720};
        EarSegmenter<float> segment;
        const Segmentation &s = segment(scan);
        QCOMPARE(s.size(), std::size_t(1));
        QCOMPARE(s.order.front(), 600);
        QCOMPARE(s.order.back(), 99);
        segment.settings.closed = false;
        QCOMPARE(segment(scan).size(), std::size_t(2));
    }

    void polarTakesIntegers() {
        std::vector<std::uint16_t> millimetres(720, 2000);
        std::fill(millimetres.begin() + 360, millimetres.end(), std::uint16_t(4000));
        millimetres[100] = 0;     // no return
        millimetres[101] = 65535; // over range
        EarSegmenter<float> segment;
        segment.settings.minThreshold = 0.1;
        const Segmentation &s = segment(PolarScan<std::uint16_t>{millimetres.data(), millimetres.size(), 0,
                                                                 2 * pi / 720, 0.001, 0.05, 60});
        QCOMPARE(s.size(), std::size_t(2));
        QCOMPARE(s.size(0), std::size_t(358));
        QCOMPARE(s.labels[100], -1);
        QCOMPARE(s.labels[101], -1);
        QCOMPARE(s.labels[102], 0);
        QCOMPARE(segment(PolarScan<std::uint16_t>()).size(), std::size_t(0));
    }

    // Thesis 5.2.2: points are compared by angle and range as the ranges of their rays are.
    void polarTakesPoints() {
        std::mt19937 random(3);
        std::normal_distribution<float> noise;
        EarSegmenter<float> ofPoints, ofRanges;
        ofPoints.settings.coordinates = EarSettings::Coordinates::Polar;
        ofPoints.settings.minPoints = ofRanges.settings.minPoints = 5;
        int unlike = 0;
        for (int scan = 0; scan < 200; ++scan) {
            std::vector<float> ranges;
            for (int i = 0; i < 500; ++i) {
                const float wall = 2 + float((i + 10 * scan) % 500 / 50 % 3);
                ranges.push_back(i % 29 == 0 ? 0 : wall + 0.1f * noise(random)); // 0: no return
            }
            const PolarScan<float> polar{ranges.data(), ranges.size(), -3, 2 * pi / 500};
            const float nan = std::numeric_limits<float>::quiet_NaN();
            Points points;
            for (std::size_t i = 0; i < ranges.size(); ++i)
                points.push_back(ranges[i] > 0 ? Vector2D<float>(polar.point(i)) : Vector2D<float>(nan, nan));
            const std::vector<int> expected = ofRanges(polar).labels;
            QVERIFY2(ofPoints(points).labels == expected, saying("scan %1", scan));
            ofPoints.settings.coordinates = EarSettings::Coordinates::Cartesian;
            unlike += ofPoints(points).labels != expected;
            ofPoints.settings.coordinates = EarSettings::Coordinates::Polar;
        }
        QVERIFY(unlike > 0);
    }

    void polarPointsOverTheWholeTurn() {
        EarSegmenter<double> segment;
        segment.settings.coordinates = EarSettings::Coordinates::Polar;
        std::vector<Vector2D<double>> points;
        for (const Vector2D<float> &p : arc(0.75 * pi, 1.25 * pi, 500, 2)) // over the direction of pi
            points.emplace_back(p);
        for (const bool closed : {true, false}) {
            segment.settings.closed = closed;
            QCOMPARE(segment(points).size(), std::size_t(1));
        }
        for (const double extreme : {0.0, 1e300, std::numeric_limits<double>::infinity()}) {
            std::vector<Vector2D<double>> strange = points;
            strange[250] = {extreme, -extreme};
            QCOMPARE(segment(strange).size(), std::size_t(1));
            QCOMPARE(segment(strange).labels[250], -1);
        }
        QCOMPARE(segment(std::vector<Vector2D<double>>()).size(), std::size_t(0));
    }

    void invalidPointsTakeNoPart() {
        Points points = arc(0, 2 * pi, 1000, 2);
        const float nan = std::numeric_limits<float>::quiet_NaN(),
                    infinity = std::numeric_limits<float>::infinity();
        points[100] = {nan, 1};
        points[101] = {infinity, infinity};
        points[500] = {1, nan};
        EarSegmenter<float> segment;
        const Segmentation &s = segment(points);
        QCOMPARE(s.size(), std::size_t(1));
        QCOMPARE(s.size(0), std::size_t(997));
        QCOMPARE(s.labels[101], -1);
        for (const Points &none : {Points{{nan, 0}}, Points(400, {1, infinity})}) {
            EarSegmenter<float> fresh; // whose buffers are empty
            const Segmentation &outliers = fresh(none);
            QCOMPARE(outliers.size(), std::size_t(0));
            QCOMPARE(outliers.labels, std::vector<int>(none.size(), -1));
        }
    }

    // Even where single points are clusters and every threshold is as large as it can be.
    void invalidRangesTakeNoPart() {
        const float infinity = std::numeric_limits<float>::infinity();
        const float none[] = {
            0, -0.0f, -1, std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, 0.04f, 60, 1e30f};
        std::vector<float> ranges(400, 2.0f);
        for (std::size_t i = 0; i < std::size(none); ++i)
            ranges[20 * i + 7] = ranges[20 * i + 8] = none[i];
        EarSegmenter<float> segment;
        segment.settings.minPoints = 1;
        segment.settings.minThreshold = 1e30;
        segment.settings.maxThreshold = double(infinity);
        for (const simd::Level level : {simd::Level::Scalar, simd::bestLevel()}) {
            segment.level = level;
            const Segmentation &s =
                segment(PolarScan<float>{ranges.data(), ranges.size(), 0, 2 * pi / 400, 1, 0.05, 60});
            QCOMPARE(s.size(), std::size_t(1));
            for (std::size_t i = 0; i < ranges.size(); ++i)
                QCOMPARE(s.labels[i], ranges[i] == 2.0f ? 0 : -1);
            Points points = arc(0, 2 * pi, 400, 2);
            points[9] = {infinity, 0};
            points[10] = {infinity, 0};
            points[399] = {0, -infinity};
            const Segmentation &t = segment(points);
            QCOMPARE(t.size(), std::size_t(1));
            QCOMPARE(t.size(0), std::size_t(397));
            QCOMPARE(t.labels[9], -1);
            QCOMPARE(t.labels[399], -1);
        }
    }

    void boundsOfRange() {
        const float around[] = {std::nextafter(0.5f, 0.0f), 0.5f, std::nextafter(2.0f, 0.0f), 2.0f};
        std::vector<float> ranges; // each in every place of eight
        for (int shift = 0; shift < 4; ++shift)
            for (int i = 0; i < 8; ++i)
                ranges.push_back(around[(i + shift) % 4]);
        EarSegmenter<float> segment;
        segment.settings.minPoints = 1;
        for (const simd::Level level : {simd::Level::Scalar, simd::bestLevel()}) {
            segment.level = level;
            const Segmentation &s =
                segment(PolarScan<float>{ranges.data(), ranges.size(), 0, 2 * pi / 32, 1, 0.5, 2});
            for (std::size_t i = 0; i < ranges.size(); ++i)
                QCOMPARE(s.labels[i] >= 0, ranges[i] >= 0.5f && ranges[i] < 2);
        }
    }

    void emptyAndTiny() {
        EarSegmenter<float> segment;
        QCOMPARE(segment(Points()).size(), std::size_t(0));
        QCOMPARE(segment(Points{{1, 1}}).size(), std::size_t(0));
        segment.settings.minPoints = 1;
        QCOMPARE(segment(Points{{1, 1}}).size(), std::size_t(1));
    }

    void edgesAreOfPointsOfTheScan() {
        Points scan;
        std::mt19937 random(3);
        std::normal_distribution<float> noise(0, 0.01f);
        for (int i = 0; i < 800; ++i) { // a square room with a stray point every 40
            const double a = 2 * pi * i / 800, r = 2 / std::max(std::abs(std::cos(a)), std::abs(std::sin(a)));
            const float range = float(i % 40 == 0 ? 0.5 * r : r) + noise(random);
            scan.emplace_back(range * float(std::cos(a)), range * float(std::sin(a)));
        }
        EdgeExtractor extract;
        double points = 0;
        const std::vector<EdgeRaw2D> &edges = extract(scan);
        for (const EdgeRaw2D &edge : edges) {
            points += edge.sums.n;
            QVERIFY(edge.segment.across({0, 0}) > 0);
        }
        QVERIFY(edges.size() >= 4);
        QVERIFY(points > 700 && points <= 780);
    }
};
