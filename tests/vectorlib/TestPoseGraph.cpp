#include <vectorlib/graph/PoseGraph.h>
#include <vectorlib/io/Tum.h>

using namespace vectorlib;

/// A drive over a grid of streets: poses a metre apart, corners at random.
static std::vector<Pose2D> driveOf(int poses, std::mt19937 &random) {
    std::vector<Pose2D> drive{{3, -2, 0.5}};
    while (int(drive.size()) < poses) {
        const Pose2D &p = drive.back();
        const double turn = random() % 5 == 0 ? (random() % 2 == 0 ? pi / 2 : -pi / 2) : 0;
        drive.push_back((Transformation2D(p) * Transformation2D(1, 0, turn)).pose());
    }
    return drive;
}
static Transformation2D between(const Pose2D &from, const Pose2D &to) {
    return Transformation2D(from).inverse() * Transformation2D(to);
}
static Eigen::Matrix3d informationOf(double xy, double alpha) {
    return Eigen::Vector3d(1 / (xy * xy), 1 / (xy * xy), 1 / (alpha * alpha)).asDiagonal();
}
static double farthest(const std::vector<Pose2D> &a, const std::vector<Pose2D> &b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, std::hypot(a[i].x - b[i].x, a[i].y - b[i].y));
    return most;
}

/// Poses and the motions measured between them.
class TestPoseGraph : public QObject {
    Q_OBJECT

    std::mt19937 random_;
    double normal(double deviation) { return std::normal_distribution<double>(0, deviation)(random_); }
    /// The motions from pose to pose with noise, and the poses that follow from them.
    PoseGraph chain(const std::vector<Pose2D> &drive, double xy, double alpha) {
        PoseGraph graph;
        graph.poses = {drive[0]};
        for (std::size_t i = 1; i < drive.size(); ++i) {
            const Transformation2D motion =
                between(drive[i - 1], drive[i]) * Transformation2D(normal(xy), normal(xy), normal(alpha));
            graph.constraints.push_back({i - 1, i, motion, informationOf(xy, alpha), false, 1});
            graph.poses.push_back((Transformation2D(graph.poses.back()) * motion).pose());
        }
        return graph;
    }
    /// True loops between any two poses, with noise.
    void addLoops(PoseGraph &graph, const std::vector<Pose2D> &drive, int count) {
        for (int i = 0; i < count; ++i) {
            const std::size_t a = random_() % drive.size(), b = random_() % drive.size();
            if (a != b)
                graph.constraints.push_back({a, b,
                                             between(drive[a], drive[b]) *
                                                 Transformation2D(normal(0.01), normal(0.01), normal(0.003)),
                                             informationOf(0.01, 0.003), true, 1});
        }
    }

private Q_SLOTS:
    void init() { random_.seed(newSeed()); }

    // Motions that agree exactly: from poses anywhere near, exactly those they came from.
    void findsPosesThatFitAllMotions() {
        for (int run = 0; run < 20; ++run) {
            const std::vector<Pose2D> drive = driveOf(40, random_);
            PoseGraph graph;
            graph.poses = drive;
            for (std::size_t i = 1; i < drive.size(); ++i)
                graph.constraints.push_back(
                    {i - 1, i, between(drive[i - 1], drive[i]), informationOf(0.1, 0.1), false, 1});
            for (int i = 0; i < 20; ++i) { // of any direction
                const std::size_t a = random_() % drive.size(), b = random_() % drive.size();
                if (a != b)
                    graph.constraints.push_back(
                        {a, b, between(drive[a], drive[b]), informationOf(0.02, 0.3), false, 1});
            }
            for (std::size_t i = 1; i < drive.size(); ++i)
                graph.poses[i] = {drive[i].x + normal(0.3), drive[i].y + normal(0.3),
                                  drive[i].theta + normal(0.1)};
            QVERIFY(graph.optimise());
            QVERIFY2(farthest(graph.poses, drive) < 1e-6, saying(farthest(graph.poses, drive)));
            for (const PoseConstraint &c : graph.constraints)
                QVERIFY(graph.squaredErrorOf(c) < 1e-9);
        }
    }

    // One pose, measured twice in other directions with other certainty: the weighted mean.
    void certainMotionsCountMore() {
        PoseGraph graph;
        graph.poses = {{1, 2, pi / 2}, {0, 0, pi / 2}};
        const Eigen::Matrix3d along = Eigen::Vector3d(400, 1, 100).asDiagonal(),
                              across = Eigen::Vector3d(1, 400, 100).asDiagonal();
        graph.constraints = {{0, 1, {1, 0, 0}, along, false, 1}, {0, 1, {2, 1, 0}, across, false, 1}};
        graph.optimise();
        const Transformation2D found = between(graph.poses[0], graph.poses[1]);
        QVERIFY(std::abs(found.x() - (400 * 1 + 2) / 401.0) < 1e-6);
        QVERIFY(std::abs(found.y() - 400 / 401.0) < 1e-6);
        QCOMPARE(graph.poses[0].x, 1.0);
        QCOMPARE(graph.poses[0].theta, pi / 2);
    }

    // What is left of the errors is what the noise leaves: as many squared deviations as there are
    // measurements more than unknowns. Of 5,000 true loops about one loses its weight.
    void aLongDriveIsStraightenedByItsLoops() {
        const std::vector<Pose2D> drive = driveOf(400, random_);
        PoseGraph graph = chain(drive, 0.02, 0.01);
        addLoops(graph, drive, 150);
        std::size_t told = 0;
        QVERIFY(graph.optimise([&told](std::size_t done, std::size_t all) {
            QVERIFY(done >= told && done <= all);
            told = done;
        }));
        QVERIFY(told > 1);
        double sum = 0, free = -3 * double(drive.size() - 1);
        int refused = 0;
        for (const PoseConstraint &c : graph.constraints) {
            refused += c.isRefused();
            sum += c.isRefused() ? 0 : graph.squaredErrorOf(c);
            free += c.isRefused() ? 0 : 3;
        }
        QVERIFY2(refused <= 3, saying(refused));
        QVERIFY2(sum > 0.7 * free && sum < 1.4 * free, saying("%1 of %2", sum, free));
    }

    void loopsThatTheOthersContradictLoseTheirWeight() {
        int right = 0, kept = 0, believed = 0;
        for (int run = 0; run < 10; ++run) {
            const std::vector<Pose2D> drive = driveOf(200, random_);
            PoseGraph graph = chain(drive, 0.02, 0.005);
            addLoops(graph, drive, 60);
            const std::size_t firstWrong = graph.constraints.size();
            for (int i = 0; i < 20; ++i) { // off by 4 m
                const std::size_t a = random_() % 100, b = 100 + random_() % 100;
                const double way = normal(pi);
                graph.constraints.push_back({a, b,
                                             between(drive[a], drive[b]) *
                                                 Transformation2D(4 * std::cos(way), 4 * std::sin(way), 0.5),
                                             informationOf(0.01, 0.003), true, 1});
            }
            graph.optimise();
            for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
                const PoseConstraint &c = graph.constraints[i];
                if (!c.mayBeWrong)
                    continue;
                right += i < firstWrong;
                (i < firstWrong ? kept : believed) += c.weight >= 0.25;
            }
        }
        QCOMPARE(believed, 0);
        QVERIFY2(kept > 0.9 * right, saying("%1 of %2", kept, right));
    }

    void whatWasRefusedCountsAgainWhenItFits() {
        PoseGraph graph;
        graph.poses = {{0, 0, 0}, {1.3, 0, 0}};
        graph.constraints = {{0, 1, {1.3, 0, 0}, informationOf(0.5, 0.1), false, 1}};
        const auto tell = [&graph](double x) {
            graph.constraints.push_back({0, 1, {x, 0, 0}, informationOf(0.01, 0.01), true, 1});
        };
        for (const double x : {1.0, 1.6, 1.6})
            tell(x);
        QVERIFY(graph.optimise());
        QVERIFY(graph.constraints[1].weight < 0.01);
        QVERIFY(graph.constraints[2].weight > 0.9);
        for (int i = 0; i < 3; ++i)
            tell(1.0);
        QVERIFY(graph.optimise());
        QVERIFY(graph.constraints[1].weight > 0.9);
        QVERIFY(graph.constraints[2].weight < 0.01);
        QVERIFY(std::abs(graph.poses[1].x - 1) < 0.01);
    }

    void whatHasNoSolutionStays() {
        PoseGraph graph;
        graph.poses = {{0, 0, 0}, {1, 0.1, 0}};
        const double none = std::nan("");
        graph.constraints = {{0, 1, {1, 0, 0}, informationOf(none, none), false, 1}};
        QVERIFY(!graph.optimise());
        QCOMPARE(graph.poses[1].y, 0.1);
    }

    void whatNothingConnectsStays() {
        PoseGraph graph;
        QVERIFY(graph.optimise());
        graph.poses = {{0, 0, 0}, {1, 0.1, 0}, {50, 60, 1}, {51, 60, 1}};
        QVERIFY(graph.optimise());
        graph.constraints = {{0, 1, {1, 0, 0}, informationOf(0.1, 0.1), false, 1}};
        graph.optimise();
        QVERIFY(std::abs(graph.poses[1].y) < 1e-6);
        QCOMPARE(graph.poses[2].x, 50.0);
        QCOMPARE(graph.poses[3].theta, 1.0);
    }

    // The information in the frame in which g2o has its errors: an error of the second pose as measured.
    void writesG2o() {
        PoseGraph graph;
        graph.poses = {{0, 0, 0}, {1, 2, pi / 2}};
        graph.constraints = {{0, 1, {1, 2, pi / 2}, Eigen::Vector3d(100, 4, 9).asDiagonal(), false, 1}};
        std::ostringstream out;
        writeG2o(out, graph);
        const QStringList lines = QString::fromStdString(out.str()).split('\n');
        QCOMPARE(lines[0], QString("VERTEX_SE2 0 0 0 0"));
        QCOMPARE(lines[2], QString("FIX 0"));
        const QStringList edge = lines[3].split(' ');
        QCOMPARE(edge.mid(0, 5).join(' '), QString("EDGE_SE2 0 1 1 2"));
        QCOMPARE(edge.size(), 12);
        const double expected[] = {4, 0, 0, 100, 0, 9};
        for (int i = 0; i < 6; ++i)
            QVERIFY(std::abs(edge[6 + i].toDouble() - expected[i]) < 1e-9);
    }
};
