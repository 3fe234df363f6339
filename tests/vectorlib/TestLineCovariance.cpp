#include <vectorlib/geometry/Angle.h>
#include <vectorlib/tls/TlsFit.h>

using namespace vectorlib;
using Points = std::vector<Vector2D<double>>;

class TestLineCovariance : public QObject {
    Q_OBJECT

    static TlsSums sumsOf(const Points &points) { return TlsSums::of(points.begin(), points.end()); }

    // Points every 2 cm on a line at `distance` from the origin that begins at `along`.
    static Points wall(double theta, double distance, double along, int count) {
        const Vector2D<double> direction(std::cos(theta), std::sin(theta));
        Points points;
        for (int i = 0; i < count; ++i)
            points.push_back(direction * (along + 0.02 * i) + direction.left() * distance);
        return points;
    }

private Q_SLOTS:
    void agreesWithMonteCarlo_data() {
        const Rows<double, double, int, bool> row("theta", "along", "count", "noiseKnown");
        row("before the sensor", 0.3, -1.0, 100, true);
        row("aside: angle and offset correlated", -2.0, 3.0, 100, true);
        row("short", 1.5, 1.0, 12, true);
        row("noise from the scatter", 2.8, -4.0, 60, false);
    }

    void agreesWithMonteCarlo() {
        FETCH(double, theta, double, along, int, count, bool, noiseKnown);
        const double noise = 0.005;
        const int trials = 20000;
        const Points exact = wall(theta, 2, along, count);
        const Line2D truth = fitLine(sumsOf(exact)).line;
        std::mt19937 random(4);
        std::normal_distribution<double> normal(0, noise);
        Eigen::Matrix2d measured = Eigen::Matrix2d::Zero(), stated = Eigen::Matrix2d::Zero();
        for (int trial = 0; trial < trials; ++trial) {
            Points points = exact;
            for (Vector2D<double> &p : points)
                p += Vector2D<double>(normal(random), normal(random));
            const TlsSums sums = sumsOf(points);
            const Line2D line = fitLine(sums).line;
            const Eigen::Vector2d error(wrapAngle(std::atan2(line.b, line.a) - std::atan2(truth.b, truth.a)),
                                        line.c - truth.c);
            measured += error * error.transpose() / trials;
            const LineCovariance covariance = lineCovariance(sums, noiseKnown ? noise : 0);
            QVERIFY(covariance.valid);
            stated += covariance.matrix / trials;
        }
        // 20,000 trials give a variance within 1 %; the rest is the first order.
        for (const auto &[i, j] : {std::pair(0, 0), std::pair(0, 1), std::pair(1, 1)}) {
            const double scale = std::sqrt(measured(i, i) * measured(j, j));
            QVERIFY2(std::abs(stated(i, j) - measured(i, j)) < 0.05 * scale,
                     saying("%1 %2: stated %3, measured %4", i, j, stated(i, j), measured(i, j)));
        }
    }

    void noDirectionHasNoCovariance() {
        const Points square{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
        for (const Points &points :
             {Points{}, Points{{1, 2}}, Points{{1, 2}, {1, 2}}, square, Points{{1, 2}, {std::nan(""), 3}}}) {
            const LineCovariance covariance = lineCovariance(sumsOf(points), 0.01);
            QVERIFY(!covariance.valid);
            QVERIFY(covariance.matrix.isZero());
        }
    }

    void threePointsTellTheirOwnNoise() {
        const Points two{{0, 1}, {1, 1}}, three{{0, 1}, {1, 1.01}, {2, 1}};
        QVERIFY(!lineCovariance(sumsOf(two)).valid);
        QVERIFY(lineCovariance(sumsOf(two), 0.01).valid);
        QVERIFY(lineCovariance(sumsOf(three)).valid);
        QVERIFY(!lineCovariance(sumsOf(three), std::nan("")).matrix.hasNaN());
    }
};
