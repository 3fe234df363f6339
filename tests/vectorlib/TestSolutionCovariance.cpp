#include <vectorlib/correspondence/CorrespondenceFinder.h>
#include <vectorlib/correspondence/SearchResult.h>

using namespace vectorlib;
using Segment = LineSegment2D<double>;

static constexpr double spacing = 0.05; // metres between points

// Free space is inside; one wall stands alone, far away and short.
static const std::vector<Segment> room{Segment({-2, -1.5}, {3, -1.5}), Segment({3, -1.5}, {3, 2}),
                                       Segment({3, 2.5}, {-2, 2}), Segment({-2.5, 1}, {-2.5, 0.2})};

static MeasuredSegments seen(const Transformation2D &from, double noise, std::mt19937 &random) {
    std::normal_distribution<double> normal(0, 1);
    MeasuredSegments result;
    for (const Segment &wall : room) {
        std::vector<Vector2D<double>> points;
        for (double t = 0; t <= wall.length(); t += spacing)
            points.push_back(from.inverse() * (wall.begin() + wall.direction() * t +
                                               Vector2D<double>(normal(random), normal(random)) * noise));
        const TlsSums sums = TlsSums::of(points.begin(), points.end());
        const Line2D line = fitLine(sums).line;
        result.segments.emplace_back(line.project(points.front()), line.project(points.back()));
        result.lines.push_back(lineCovariance(sums, noise));
    }
    return result;
}

// How sure a solution of the correspondence search is, against repeated measurements of the same walls.
class TestSolutionCovariance : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void agreesWithMonteCarlo_data() {
        const Rows<double, double, double, double> row("x", "y", "alpha", "mapNoise");
        row("no motion", 0.0, 0.0, 0.0, 0.01);
        row("motion", 0.7, -0.4, 0.6, 0.01);
        row("a map that is known exactly", 0.7, 0.4, -0.3, 0.0);
    }

    void agreesWithMonteCarlo() {
        FETCH(double, x, double, y, double, alpha, double, mapNoise);
        const Transformation2D truth(x, y, alpha);
        constexpr int runs = 4000;
        std::mt19937 random(7);
        CorrespondenceFinder find;
        Eigen::Matrix3d measured = Eigen::Matrix3d::Zero(), told = Eigen::Matrix3d::Zero();
        for (int i = 0; i < runs; ++i) {
            MeasuredSegments fixed = seen({}, mapNoise, random);
            if (mapNoise <= 0)
                fixed.lines.assign(room.size(), LineCovariance::exact());
            const MeasuredSegments moving = seen(truth, 0.01, random);
            const SearchResult &result = find(fixed.segments, moving.segments, truth);
            QVERIFY(!result.solutions.empty());
            const Solution &best = result.solutions[0];
            QCOMPARE(best.pairs.size(), room.size());
            const auto covariance = SolutionCovariance()(best, fixed, moving);
            QVERIFY(covariance);
            told += *covariance / runs;
            const Eigen::Vector3d error(best.pose.x() - x, best.pose.y() - y, best.pose.alpha() - alpha);
            measured += error * error.transpose() / runs;
        }
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
                QVERIFY2(std::abs(measured(a, b) - told(a, b)) < 0.1 * std::sqrt(told(a, a) * told(b, b)),
                         saying("(%1, %2): measured %3, told %4", a, b, measured(a, b), told(a, b)));
    }

    void nothingWhereNothingIsKnown() {
        std::mt19937 random(8);
        const MeasuredSegments walls = seen({}, 0.01, random);
        CorrespondenceFinder find;
        const Solution best = find(walls.segments, walls.segments).solutions.at(0);
        const SolutionCovariance covariance;
        QVERIFY(covariance(best, walls, walls));
        QVERIFY(!covariance(Solution(), walls, walls));
        QVERIFY(!covariance(best, walls, {walls.segments, {}}));
        MeasuredSegments unsure = walls;
        unsure.lines[1] = LineCovariance();
        QVERIFY(!covariance(best, walls, unsure));
        Solution foreign = best;
        foreign.pairs.push_back({0, 99});
        QVERIFY(!covariance(foreign, walls, walls));
    }
};
