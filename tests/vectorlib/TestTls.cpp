#include <vectorlib/tls/TlsFit.h>

using namespace vectorlib;

static std::vector<Vector2D<double>> noisyLine(double theta, double distance, int count, double sigma,
                                               Vector2D<double> offset = {}, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise;
    const Vector2D<double> d(std::cos(theta), std::sin(theta)), n = d.left();
    std::vector<Vector2D<double>> points;
    for (int i = 0; i < count; ++i)
        points.push_back(offset + d * (0.01 * i - 0.003 * count) + n * (distance + sigma * noise(random)));
    return points;
}

static TlsSums sumsOf(const std::vector<Vector2D<double>> &points) {
    return TlsSums::of(points.begin(), points.end());
}

class TestTls : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void fitsAnyDirection_data() {
        const Rows<double> row("theta");
        for (int degrees = -180; degrees < 180; degrees += 15)
            row(qPrintable(QString("%1 degrees").arg(degrees)), degrees * pi / 180);
    }

    void fitsAnyDirection() {
        QFETCH(double, theta);
        const TlsLine fit = fitLine(sumsOf(noisyLine(theta, 2.0, 500, 0.01)));
        QVERIFY(fit.line.isValid());
        QVERIFY(std::abs(fit.line.a * fit.line.a + fit.line.b * fit.line.b - 1) < 1e-12); // (6.6)
        QVERIFY(fit.line.c >= 0);
        QVERIFY(std::abs(fit.line.c - 2.0) < 0.005);
        QVERIFY(std::abs(fit.line.direction().cross({std::cos(theta), std::sin(theta)})) < 0.003);
        QVERIFY(std::abs(std::sqrt(fit.variance) - 0.01) < 0.002);
    }

    // Erratum 1: thesis (6.2) with the DIFFERENCE in the denominator and atan2 gives our line; as printed it
    // does not.
    void traditionalFormulaNeedsItsErratum() {
        const TlsSums s = sumsOf(noisyLine(1.9, 2.0, 300, 0.01));
        const double corrected = 0.5 * std::atan2(2 * s.xy, s.xx - s.yy);
        const double printed = 0.5 * std::atan(2 * s.xy / (s.xx + s.yy));
        const Vector2D<double> direction = fitLine(s).line.direction();
        const auto turn = [&](double theta) {
            return std::abs(direction.cross({std::cos(theta), std::sin(theta)}));
        };
        QVERIFY(turn(corrected) < 1e-12);
        QVERIFY(turn(printed) > 0.1);
    }

    void noDirectionIsReported_data() {
        const Rows<QVector<QPointF>> row("points");
        row("none", {});
        row("one", {{3, 4}});
        row("two equal", {{3, 4}, {3, 4}});
        row("a square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
        row("a far triangle", {{10001, 0}, {9999.5, 0.86602540378443865}, {9999.5, -0.86602540378443865}});
    }

    void noDirectionIsReported() { // erratum 2: p = q = 0
        QFETCH(QVector<QPointF>, points);
        std::vector<Vector2D<double>> p;
        for (const QPointF &q : points)
            p.emplace_back(q.x(), q.y());
        const TlsLine fit = fitLine(sumsOf(p));
        if (points.size() ==
            3) // isotropic up to the rounding of its coordinates: any direction, but never NaN
            QVERIFY(std::isfinite(fit.line.a) && std::isfinite(fit.variance));
        else
            QVERIFY(!fit.line.isValid());
        QVERIFY(std::isfinite(fit.line.c));
    }

    // Erratum 2: with q = 0, n = p/q of (6.16) is infinite and 1/sqrt(4n^2+1) must come out as 0.
    void ratioOfZeroDenominator() {
        const TlsSums s = sumsOf({{1, 0}, {2, 1}, {3, 2}}); // 45 degrees: sum of squares equal in x and y
        const double q = s.xx - s.yy, n = -s.xy / q;
        QVERIFY(std::isinf(n));
        const TlsLine fit = fitLine(s);
        QVERIFY(std::abs(fit.line.direction().cross({std::sqrt(0.5), std::sqrt(0.5)})) < 1e-12);
        QVERIFY(fit.variance < 1e-20);
    }

    // Erratum 3: at 10 km the plain sums of (6.22) lose the variance; shifted by the first point they keep
    // it.
    void varianceHoldsFarFromTheOrigin() {
        const auto near = noisyLine(0.3, 2.0, 400, 0.01);
        auto far = near;
        for (Vector2D<double> &p : far)
            p += Vector2D<double>(10000, -10000);
        const double expected = fitLine(sumsOf(near)).variance;
        const TlsLine fit = fitLine(sumsOf(far));
        QVERIFY2(std::abs(fit.variance / expected - 1) < 1e-6, saying(fit.variance / expected - 1));

        double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
        for (const Vector2D<double> &p : far) {
            n += 1, x += p.x, y += p.y, xx += p.x * p.x, xy += p.x * p.y, yy += p.y * p.y;
        }
        const double a = fit.line.a, b = fit.line.b, c = -(a * x + b * y) / n;
        const double printed = (a * a * xx + 2 * a * b * xy + b * b * yy) / n - c * c; // (6.22)
        QVERIFY(std::abs(printed / expected - 1) > 1e-6);
    }

    void sumOfUnionIsExact() {
        const auto all = noisyLine(0.7, 3.0, 300, 0.02, {50, -20});
        const std::vector<Vector2D<double>> left(all.begin(), all.begin() + 100),
            right(all.begin() + 100, all.end());
        const TlsSums joint = sumsOf(left) + sumsOf(right), direct = sumsOf(all);
        QCOMPARE(joint.n, direct.n);
        QVERIFY((joint.mean - direct.mean).norm() < 1e-12);
        QVERIFY(std::abs(joint.xx - direct.xx) < 1e-9 && std::abs(joint.xy - direct.xy) < 1e-9 &&
                std::abs(joint.yy - direct.yy) < 1e-9);
        QCOMPARE((TlsSums() + direct).xx, direct.xx);
    }

    void sumOfTransformedPointsIsExact() {
        auto points = noisyLine(0.7, 3.0, 300, 0.02);
        const Transformation2D t(12, -3, 2.1);
        const TlsSums moved = t * sumsOf(points);
        for (Vector2D<double> &p : points)
            p = t * p;
        const TlsSums direct = sumsOf(points);
        QVERIFY((moved.mean - direct.mean).norm() < 1e-12);
        QVERIFY(std::abs(moved.xx - direct.xx) < 1e-9 && std::abs(moved.xy - direct.xy) < 1e-9 &&
                std::abs(moved.yy - direct.yy) < 1e-9);
    }

    void momentsOfAStraightLineStayPositive() {
        const TlsSums s = sumsOf(noisyLine(0.3, 2.0, 100, 0));
        for (int i = 0; i < 1000; ++i) {
            const TlsSums moved = Transformation2D(1, 2, 0.01 * i - 0.3) * s; // some of them onto an axis
            QVERIFY(moved.xx >= 0 && moved.yy >= 0);
            QVERIFY(std::isfinite(fitLine(moved).variance));
        }
    }

    void thresholdTestAgreesWithTheVariance() {
        for (unsigned seed = 1; seed < 500; ++seed) {
            const TlsSums s = sumsOf(noisyLine(seed * 0.1, 2.0, 3 + int(seed % 50), 0.02, {}, seed));
            const double sigma = std::sqrt(fitLine(s).variance);
            QVERIFY(fitsWithin(s, sigma * 1.0001 + 1e-12));
            QVERIFY(sigma < 1e-9 || !fitsWithin(s, sigma * 0.9999));
        }
    }
};
