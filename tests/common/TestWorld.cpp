#include "common/world/World.h"

using namespace hermes;
using vectorlib::Pose2D;

static const char *square = "{\"edges\": [[0,0,1,0],\n[1,0,1,1],\n[1,1,0,0]], \"poses\": [\n[0.5,0.5,0]]}";

static double distance(const World::Edge &e, double x, double y) {
    const double dx = e.x2 - e.x1, dy = e.y2 - e.y1;
    const double t = ((x - e.x1) * dx + (y - e.y1) * dy) / (dx * dx + dy * dy);
    const double along = std::min(1.0, std::max(0.0, t));
    return std::hypot(x - e.x1 - along * dx, y - e.y1 - along * dy);
}

/// A world of deploy/worlds.
static Outcome<World> shipped(const QString &name) {
    const QString path = qEnvironmentVariable("HERMES_SOURCE") + "/deploy/worlds/" + name + ".json";
    const auto world = readWorld(path.toStdString());
    if (!world)
        qWarning("%s", world.error().c_str());
    return world;
}

class TestWorld : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void refusesBadFiles_data() {
        Rows<QByteArray, QByteArray>("text", "message"); // message: what it begins with
        const QByteArray good = square;
        const auto with = [&](const char *from, const QByteArray &to) {
            return QByteArray(good).replace(from, to);
        };
        QTest::newRow("empty") << QByteArray() << QByteArray("w:1: not JSON: ");
        QTest::newRow("a list") << QByteArray("[]")
                                << QByteArray("w: an object with \"edges\" expected, found array");
        QTest::newRow("no edges") << QByteArray("{\"name\": \"x\"}") << QByteArray("w: no edges: ");
        QTest::newRow("empty edges") << QByteArray("{\"edges\": []}") << QByteArray("w: no edges: ");
        QTest::newRow("edges no list")
            << QByteArray("{\"edges\": 3}") << QByteArray("w: \"edges\": a list of ");
        QTest::newRow("cut") << good.left(20) << QByteArray("w:1: not JSON: ");
        QTest::newRow("NaN") << with("1,0,1,1", "NaN,0,1,1") << QByteArray("w:2: not JSON: ");
        QTest::newRow("null") << with("1,0,1,1", "null,0,1,1")
                              << QByteArray("w:2: edges[1]: [x1, y1, x2, y2] in metres expected, found null");
        QTest::newRow("beyond a double")
            << with("1,0,1,1", "1e999,0,1,1") << QByteArray("w:2: not JSON: number overflow");
        QTest::newRow("three numbers")
            << with("[1,1,0,0]", "[1,1,0]")
            << QByteArray("w:3: edges[2]: [x1, y1, x2, y2] in metres expected, found 3 values");
        QTest::newRow("text") << with("1,0,1,1", "\"1\",0,1,1")
                              << QByteArray(
                                     "w:2: edges[1]: [x1, y1, x2, y2] in metres expected, found \"1\"");
        QTest::newRow("no length") << with("[1,1,0,0]", "[1,1,1,1]")
                                   << QByteArray("w:3: edges[2]: an edge must not begin where it ends");
        QTest::newRow("pose")
            << with("[0.5,0.5,0]", "[0.5,0.5]")
            << QByteArray("w:4: poses[0]: [x, y, theta] in metres and radians expected, found 2 values");
        QTest::newRow("edge no list") << with("[1,0,1,1]", "{\"x\": 1}") << QByteArray("w:2: edges[1]: ");
        QTest::newRow("unknown key") << with("poses", "pose")
                                     << QByteArray("w: unknown key \"pose\", expected are ");
        QTest::newRow("twice") << QByteArray("{\"edges\": [[0,0,1,0]],\n\"edges\": []}")
                               << QByteArray("w:2: \"edges\" appears twice");
        const auto people = [&](const QByteArray &row) {
            return with("]}", "],\n\"people\": [[1,0,0,1,0],\n" + row + "]}");
        };
        QTest::newRow("person") << people("[1,0,0]")
                                << QByteArray(
                                       "w:6: people[1]: [speed, x1, y1, x2, y2, ...] in m/s and metres "
                                       "expected, found 3 values");
        QTest::newRow("half a point") << people("[1,0,0,1,0,2]") << QByteArray("w:6: people[1]: ");
        QTest::newRow("nobody walks") << people("[0,0,0,1,0]") << QByteArray("w:6: people[1]: ");
        QTest::newRow("nobody runs so fast") << people("[11,0,0,1,0]") << QByteArray("w:6: people[1]: ");
        QTest::newRow("no way") << people("[1,0,0,1,0,1,0]") << QByteArray("w:6: people[1]: ");
        QTest::newRow("person no list") << people("3") << QByteArray("w:6: people[1]: ");
        QTest::newRow("more behind") << good + "x" << QByteArray("w:4: not JSON: ");
    }

    void refusesBadFiles() {
        FETCH(QByteArray, text, QByteArray, message);
        QVERIFY(parseWorld(square, "w").ok());
        const auto world = parseWorld(text.toStdString(), "w");
        QVERIFY(!world);
        QVERIFY2(QByteArray::fromStdString(world.error()).startsWith(message), world.error().c_str());
    }

    void saysWhichFileIsMissing() {
        const auto world = readWorld("/nonexistent/w.json");
        QVERIFY(!world);
        QCOMPARE(QByteArray::fromStdString(world.error()),
                 QByteArray("/nonexistent/w.json: cannot be read: No such file or directory"));
        QVERIFY(!readWorld("/"));
    }

    void worldsCanBeDriven_data() {
        const Rows<QString, int, int, double> row("name", "edges", "poses", "step");
        row("pillars", "pillars", 4 + 8 * 4, 39, 0.67);
        row("quadratic", "quadratic", 3 + 12 + 11, 25, 0.56);
        row("laboratory", "laboratory", 96, 10, 0.6);
    }

    void worldsCanBeDriven() {
        FETCH(QString, name, int, edges, int, poses, double, step);
        const auto world = shipped(name);
        QVERIFY(world.ok());
        QCOMPARE(QString::fromStdString(world->name), name);
        QCOMPARE(int(world->edges.size()), edges);
        QCOMPARE(int(world->poses.size()), poses);
        for (std::size_t i = 0; i < world->poses.size(); ++i) {
            const Pose2D &pose = world->poses[i];
            for (const World::Edge &edge : world->edges)
                QVERIFY(distance(edge, pose.x, pose.y) > 0.35);
            if (i == 0)
                continue;
            const Pose2D &last = world->poses[i - 1];
            const double moved = std::hypot(pose.x - last.x, pose.y - last.y);
            QVERIFY(moved > step - 0.07 && moved < step + 0.03);
            QVERIFY(std::abs(std::remainder(pose.theta - last.theta, 2 * M_PI)) < 0.6);
            const double course = std::atan2(pose.y - last.y, pose.x - last.x);
            QVERIFY(std::abs(std::remainder(pose.theta - course, 2 * M_PI)) <
                    0.35); // the heading follows the path
        }
    }

    void stairsGrowQuadratically() {
        const auto world = shipped("quadratic");
        QVERIFY(world.ok());
        int treads = 0;
        for (const World::Edge &edge : world->edges)
            if (edge.x2 < edge.x1) { // with free space below
                QCOMPARE(edge.y1, edge.y2);
                QVERIFY(std::abs(edge.y1 - (6 - 0.01 * treads * treads)) < 1e-9);
                ++treads;
            }
        QCOMPARE(treads, 12);
    }

    void roomsAreClosed_data() {
        const Rows<int> row("edges");
        row("cutsquare", 5);
        row("oblique", 19);
    }

    void roomsAreClosed() { // one polygon, free space inside, every pose in it
        QFETCH(int, edges);
        const auto world = shipped(QString::fromLatin1(QTest::currentDataTag()));
        QVERIFY(world.ok());
        QCOMPARE(world->edges.size(), std::size_t(edges));
        QVERIFY(world->poses.size() >= 10);
        for (std::size_t i = 0; i < world->edges.size(); ++i) {
            const World::Edge &edge = world->edges[i], &next = world->edges[(i + 1) % world->edges.size()];
            QVERIFY(edge.x2 == next.x1 && edge.y2 == next.y1);
        }
        for (const Pose2D &pose : world->poses) {
            double turns = 0; // the edges go once around it, counter-clockwise
            for (const World::Edge &e : world->edges) {
                QVERIFY(distance(e, pose.x, pose.y) > 0.35);
                turns += std::remainder(std::atan2(e.y2 - pose.y, e.x2 - pose.x) -
                                            std::atan2(e.y1 - pose.y, e.x1 - pose.x),
                                        2 * M_PI) /
                         (2 * M_PI);
            }
            QVERIFY(std::abs(turns - 1) < 1e-9);
        }
    }

    void theTourIsLargeAndOpen() {
        const auto world = shipped("tour");
        QVERIFY(world.ok());
        double width = 0, depth = 0;
        for (const World::Edge &edge : world->edges) {
            width = std::max({width, edge.x1, edge.x2});
            depth = std::max({depth, edge.y1, edge.y2});
        }
        QVERIFY(width >= 60 && depth >= 40); // its corner is the origin
        const auto clear = [&](double x, double y, double room) {
            return std::all_of(world->edges.begin(), world->edges.end(),
                               [&](const World::Edge &edge) { return distance(edge, x, y) > room; });
        };
        double length = 0;
        for (std::size_t i = 1; i < world->poses.size(); ++i) {
            const Pose2D &pose = world->poses[i], &last = world->poses[i - 1];
            QVERIFY(clear(pose.x, pose.y, 0.9));
            length += std::hypot(pose.x - last.x, pose.y - last.y);
        }
        QVERIFY(length > 360); // each corridor twice
        QCOMPARE(world->poses.back().x, world->poses.front().x);
        QCOMPARE(world->poses.back().y, world->poses.front().y);
        QVERIFY(world->people.size() >= 10);
        for (const World::Person &person : world->people) {
            for (std::size_t i = 1; i < person.way.size(); ++i)
                for (double t = 0; t <= 1; t += 0.01) {
                    const auto at = person.way[i - 1] + (person.way[i] - person.way[i - 1]) * t;
                    QVERIFY(clear(at.x, at.y, 0.3));
                }
        }
    }
};
