#include <vectorlib/registration/RegistrationCovariance.h>

using namespace vectorlib;
using Segment = LineSegment2D<double>;

// How sure a registration is, against repeated measurements of the same walls.
class TestRegistrationCovariance : public QObject {
    Q_OBJECT

    static constexpr double spacing = 0.05; // metres between points

    /// A wall as points see it: the segment with its fit, and how sure the fit is.
    struct Seen {
        Segment segment;
        LineCovariance covariance;
    };

    static Seen see(const Segment &wall, double noise, std::mt19937 &random) {
        std::normal_distribution<double> normal(0, 1);
        std::vector<Vector2D<double>> points;
        for (double t = 0; t <= wall.length(); t += spacing)
            points.push_back(wall.begin() + wall.direction() * t +
                             Vector2D<double>(normal(random), normal(random)) * noise);
        const TlsSums sums = TlsSums::of(points.begin(), points.end());
        const Line2D line = fitLine(sums).line;
        return {Segment(line.project(wall.begin()), line.project(wall.end())), lineCovariance(sums, noise)};
    }

    // Static walls around the sensor, one of them with the origin behind it.
    static inline const std::vector<Segment> room{Segment({-2, -1.5}, {3, -1.5}), Segment({3, -1.5}, {3, 2}),
                                                  Segment({1, 2.5}, {-2, 2}),
                                                  Segment({-1, 0.2}, {-0.4, 0.4})};

    static double weightOf(const Segment &a, const Segment &b) { return std::min(a.length(), b.length()); }

private Q_SLOTS:
    void agreesWithMonteCarlo_data() {
        const Rows<double, double, double, int, double> row("x", "y", "alpha", "rotation", "mapNoise");
        row("no motion", 0.0, 0.0, 0.0, int(Rotation::Mitsuta), 0.01);
        row("far motion: the map's angles move the result", 4.0, -3.0, 0.5, int(Rotation::Mitsuta), 0.02);
        row("wahba", 0.5, 0.3, -2.0, int(Rotation::Wahba), 0.01);
        row("exact map", 1.0, 0.0, 3.0, int(Rotation::Mitsuta), 0.0);
    }

    void agreesWithMonteCarlo() {
        FETCH(double, x, double, y, double, alpha, int, rotation, double, mapNoise);
        const Transformation2D truth(x, y, alpha);
        constexpr int trials = 10000;
        std::mt19937 random(5);
        Eigen::Matrix3d measured = Eigen::Matrix3d::Zero(), stated = Eigen::Matrix3d::Zero();
        for (int trial = 0; trial < trials; ++trial) {
            std::vector<SegmentPair> pairs;
            std::vector<std::pair<LineCovariance, LineCovariance>> sure;
            LineSegmentRegistration registration;
            registration.rotation = Rotation(rotation);
            for (const Segment &wall : room) {
                const Seen fixed =
                    mapNoise > 0 ? see(wall, mapNoise, random) : Seen{wall, LineCovariance::exact()};
                const Seen moving = see(truth.inverse() * wall, 0.01, random);
                pairs.push_back({fixed.segment, moving.segment, weightOf(fixed.segment, moving.segment)});
                sure.emplace_back(fixed.covariance, moving.covariance);
            }
            registration.add(pairs);
            RegistrationCovariance covariance(registration);
            for (std::size_t i = 0; i < pairs.size(); ++i)
                QVERIFY(covariance.add(pairs[i], sure[i].first, sure[i].second));
            stated += *covariance() / trials;
            const Transformation2D t = registration.transformation();
            const Eigen::Vector3d error(t.x() - x, t.y() - y, wrapAngle(t.alpha() - alpha));
            measured += error * error.transpose() / trials;
        }
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                QVERIFY2(std::abs(measured(i, j) - stated(i, j)) <
                             0.06 * std::sqrt(measured(i, i) * measured(j, j)),
                         saying("(%1, %2): measured %3, stated %4", i, j, measured(i, j), stated(i, j)));
    }

    void knownMapAddsNothing() {
        std::mt19937 random(6);
        LineSegmentRegistration registration;
        for (const Segment &wall : room)
            registration.add(wall, wall);
        RegistrationCovariance exact(registration), alsoMap(registration), nothing(registration);
        for (const Segment &wall : room) {
            const LineCovariance sure = see(wall, 0.01, random).covariance;
            exact.add({wall, wall, 1}, LineCovariance::exact(), sure);
            alsoMap.add({wall, wall, 1}, sure, sure);
            nothing.add({wall, wall, 1}, LineCovariance::exact(), LineCovariance::exact());
        }
        QVERIFY(exact()->trace() > 0);
        QVERIFY((*alsoMap() - 2 * *exact()).norm() < 1e-9 * exact()->norm()); // two equal errors
        QCOMPARE(nothing()->norm(), 0.0);
    }

    void halfTheNoiseIsAQuarterOfTheVariance() {
        LineSegmentRegistration registration;
        for (const Segment &wall : room)
            registration.add(wall, wall);
        const auto covariance = [&](double noise) {
            RegistrationCovariance result(registration);
            for (const Segment &wall : room) {
                const std::vector<Vector2D<double>> points{wall.begin(), wall.middle(), wall.end()};
                result.add({wall, wall, 1}, LineCovariance::exact(),
                           lineCovariance(TlsSums::of(points.begin(), points.end()), noise));
            }
            return *result();
        };
        QVERIFY((covariance(0.02) - 4 * covariance(0.01)).norm() < 1e-9 * covariance(0.02).norm());
    }

    void nothingWhereNothingIsKnown() {
        const LineCovariance exact = LineCovariance::exact();
        QVERIFY(!RegistrationCovariance(LineSegmentRegistration())());
        LineSegmentRegistration parallel, solvable;
        for (double y : {0.0, 1.0})
            parallel.add(Segment({0, y}, {1, y}), Segment({0, y}, {1, y}));
        RegistrationCovariance ofParallel(parallel);
        QVERIFY(!ofParallel.add({room[0], room[0], 1}, exact, exact));
        QVERIFY(!ofParallel());
        for (const Segment &wall : room)
            solvable.add(wall, wall);
        const LineCovariance unknown; // not valid
        for (const auto &[pair, sure] : {std::make_pair(SegmentPair{room[0], room[0], 1}, unknown),
                                         std::make_pair(SegmentPair{room[0], room[0], 0}, exact),
                                         std::make_pair(SegmentPair{room[0], Segment(), 1}, exact)}) {
            RegistrationCovariance covariance(solvable);
            for (const Segment &wall : room)
                QVERIFY(covariance.add({wall, wall, 1}, exact, exact));
            QVERIFY(covariance());
            QVERIFY(!covariance.add(pair, sure, exact));
            QVERIFY(!covariance());
        }
        RegistrationCovariance noPairs(solvable);
        QVERIFY(!noPairs());
    }
};
