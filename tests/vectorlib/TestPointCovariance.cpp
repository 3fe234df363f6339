#include <vectorlib/mapping/GlobalPairMatcher.h>

#include "tests/vectorlib/ScanWorld.h"
#include <vectorlib/observation/FloorPlan.h>

#include <Eigen/LU>

using namespace vectorlib;
using Points = ScanWorld::Points;

/// How sure a match of points is, as it tells itself.
class TestPointCovariance : public QObject {
    Q_OBJECT

    static double between(std::mt19937 &random, double a, double b) {
        return a + (b - a) * double(random() % 100001) / 100000;
    }
    /// Two scans of a place at random, and the motion between them.
    struct ScanPair {
        Points fixed, moving;
        Transformation2D motion;
    };
    static void addBox(ScanWorld &world, const Transformation2D &place, double width, double depth) {
        const ScanWorld::Point corners[] = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
        for (int i = 0; i < 4; ++i)
            world.walls.emplace_back(place * corners[i], place * corners[(i + 1) % 4]);
    }
    /// A room with boxes, but for the middle.
    static ScanWorld clutter(std::mt19937 &random, int boxes) {
        const double width = between(random, 5, 10), depth = between(random, 4, 8);
        ScanWorld world = ScanWorld::of({{0, 0}, {width, 0}, {width, depth}, {0, depth}});
        for (int i = 0; i < boxes; ++i) {
            const double x = between(random, 0.1, width - 1), y = between(random, 0.1, depth - 1);
            if (std::hypot(x + 0.25 - width / 2, y + 0.25 - depth / 2) > 1.5)
                addBox(world, {x, y, between(random, 0, 1.5)}, between(random, 0.1, 0.5),
                       between(random, 0.2, 0.6));
        }
        const ScanWorld::Point middle(width / 2, depth / 2);
        for (auto &wall : world.walls)
            wall = {wall.begin() - middle, wall.end() - middle};
        return world;
    }
    /// A corridor between two ends, with niches on one side.
    static ScanWorld corridor(std::mt19937 &random) {
        const double half = between(random, 6, 12), width = between(random, 1.8, 3);
        std::vector<ScanWorld::Point> corners{{-half, -width / 2}};
        for (double x = between(random, 0.5, 2) - half; x + 1 < half; x += between(random, 1.5, 5))
            corners.insert(
                corners.end(),
                {{x, -width / 2}, {x, -width / 2 - 0.3}, {x + 0.9, -width / 2 - 0.3}, {x + 0.9, -width / 2}});
        corners.insert(corners.end(), {{half, -width / 2}, {half, width / 2}, {-half, width / 2}});
        return ScanWorld::of(corners);
    }
    static ScanPair drawPair(std::mt19937 &random, int number, double noise) {
        Transformation2D from(0, 0, between(random, -3, 3));
        ScanWorld world;
        if (number % 3 == 0) {
            FloorPlan plan(unsigned(random()), 8);
            world.walls = plan.walls();
            from = Transformation2D(plan.place());
        } else
            world = number % 3 == 1 ? clutter(random, int(random() % 20)) : corridor(random);
        const bool half = random() % 2 == 0;
        const int rays[] = {180, 360, 720, 1440};
        const ScanWorld::Scanner scanner{rays[random() % 4], half ? pi : 2 * pi, noise, 30};
        const double far = between(random, 0, 0.7), way = between(random, -3, 3);
        const double turn = half ? 0.5 : 3;
        ScanPair pair;
        pair.motion = {far * std::cos(way), far * std::sin(way), between(random, -turn, turn)};
        pair.fixed = world.scan(from, random, scanner);
        pair.moving = world.scan(from * pair.motion, random, scanner);
        return pair;
    }
    static Eigen::Vector3d errorOf(const Transformation2D &found, const Transformation2D &motion) {
        return {found.x() - motion.x(), found.y() - motion.y(), (motion.inverse() * found).alpha()};
    }
    /// What is told of two scans at the pose that is found from the motion given.
    static Eigen::Matrix3d told(const Points &fixed, const Points &moving, const Transformation2D &motion,
                                const PointCovariance &tell = {}) {
        PointRefinement refine;
        refine.start(fixed, moving);
        return tell(refine, refine(motion, {{}, 1e6, 1e6}));
    }
    static Eigen::Vector3d deviations(const Eigen::Matrix3d &covariance) {
        return covariance.diagonal().cwiseSqrt();
    }

private Q_SLOTS:
    void errorsAreAsTold_data() {
        QTest::addColumn<double>("noise");
        for (const double centimetres : {0.5, 1.0, 2.0, 3.0, 5.0})
            QTest::addRow("%g cm", centimetres) << centimetres / 100;
    }

    // The squared Mahalanobis distances of right matches from the true motion: their mean would be 3, and 1 %
    // above 11.34, if errors were normal and told exactly.
    void errorsAreAsTold() {
        QFETCH(double, noise);
        constexpr unsigned seed = 1;
        constexpr int pairs = 300;
        std::mt19937 random(seed);
        GlobalPairMatcher match;
        double sum = 0, count = 0, far = 0;
        for (int i = 0; i < pairs; ++i) {
            const ScanPair pair = drawPair(random, i, noise);
            const GlobalPairMatch &found = match(pair.fixed, pair.moving);
            if (!found.isAccepted())
                continue;
            const Eigen::Vector3d error = errorOf(found.solutions[0].pose, pair.motion);
            if (error.head<2>().norm() > 0.3 || std::abs(error(2)) > 0.15)
                continue;
            const double square = error.dot(match.covarianceOf(found.solutions[0]).inverse() * error);
            sum += square;
            far += square > 11.34;
            ++count;
        }
        const QString text =
            QString(saying("seed %1: %2 pairs, mean %3, far %4", seed, count, sum / count, far / count));
        QVERIFY2(count > 0.7 * pairs, qPrintable(text));
        QVERIFY2(sum > 1.5 * count && sum < 4.5 * count && far < 0.05 * count, qPrintable(text));
    }

    // The second scan has one wall 4 cm off and rough, in pieces that have 20 points each: points beside each
    // other err alike.
    void misfitIsNotAveragedAway() {
        std::mt19937 random(2);
        const ScanWorld::Scanner scanner{360, 2 * pi, 0.005};
        const Points fixed = ScanWorld::room().scan({}, random, scanner);
        Points moving = ScanWorld::room().scan({}, random, scanner);
        const double before = deviations(told(fixed, moving, {}))(0);
        for (std::size_t i = 0; i < moving.size(); ++i)
            if (moving[i].x > 3.9)
                moving[i].x += i / 20 % 2 == 0 ? 0.04f : -0.04f;
        const double after = deviations(told(fixed, moving, {}))(0);
        QVERIFY2(after > 2 * before, saying("%1 %2", before, after));
    }

    void whatNothingHoldsIsUnknown() {
        std::mt19937 random(3);
        const ScanWorld::Scanner scanner{360, 2 * pi, 0.01, 30};
        const Transformation2D turned(0, 0, 0.6); // so that the corridor has no axis's direction
        const Points corridor = ScanWorld::corridor().scan(turned, random, scanner),
                     again = ScanWorld::corridor().scan(turned, random, scanner);
        const Eigen::Matrix3d open = told(corridor, again, {});
        const Eigen::Vector3d along(std::cos(0.6), -std::sin(0.6), 0),
            across(std::sin(0.6), std::cos(0.6), 0);
        QVERIFY(across.dot(open * across) < 0.005 * 0.005 && open(2, 2) < 0.005 * 0.005);
        QVERIFY(along.dot(open * along) > 0.1 * 0.1);

        Points circle;
        for (int degree = -180; degree < 180; ++degree)
            circle.push_back(Vector2D<float>(
                ScanWorld::Point(std::cos(degree * pi / 180), std::sin(degree * pi / 180)) * 3.0));
        QVERIFY(told(circle, circle, {})(2, 2) > 0.1 * 0.1);

        const Points nothing;
        QVERIFY(told(nothing, nothing, {}) == Eigen::Matrix3d::Identity() * 1e4);
    }

    void noiseThatIsGivenCounts() {
        std::mt19937 random(4);
        const Points fixed = ScanWorld::room().scan({}, random), moving = ScanWorld::room().scan({}, random);
        PointCovariance tell;
        tell.noise = 0.01;
        const Eigen::Matrix3d one = told(fixed, moving, {}, tell);
        tell.noise = 0.03;
        const Eigen::Matrix3d three = told(fixed, moving, {}, tell);
        QVERIFY((three - 9 * one).norm() < 1e-9 * three.norm());
        const Eigen::Vector3d own = deviations(told(fixed, moving, {})); // the scans have 1 cm of noise
        for (int i = 0; i < 3; ++i)
            QVERIFY(own(i) > 0.4 * deviations(one)(i) && own(i) < 1.6 * deviations(one)(i));
    }

    void exactScansLeaveALittle() {
        std::mt19937 random(5);
        const ScanWorld::Scanner exact{360, 2 * pi, 0};
        const Points scan = ScanWorld::room().scan({}, random, exact);
        const Eigen::Matrix3d covariance = told(scan, scan, {});
        QVERIFY(covariance.determinant() > 0 && covariance(0, 0) > 0 && deviations(covariance)(0) < 1e-3);
    }
};
