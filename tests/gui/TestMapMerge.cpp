#include "tests/gui/VectorProgram.h"

#include <vectorlib/io/MapCsv.h>
#include <vectorlib/observation/FloorPlan.h>

/// hermes-vector map-merge: two maps become one where they show the same place.
class TestMapMerge : public QObject, protected TestFolder {
    Q_OBJECT

    using Wall = vectorlib::LineSegment2D<double>;
    using Map = std::vector<vectorlib::MapEdge>;

    const vectorlib::Transformation2D motion_{3, -4, 2}; // from the second map to the first

    static Map mapOf(const std::vector<Wall> &walls, double from, double to,
                     const vectorlib::Transformation2D &motion) {
        Map map;
        for (const Wall &wall : walls) {
            if (wall.middle().x < from || wall.middle().x > to || wall.length() < 0.05)
                continue;
            const Wall moved = motion * wall;
            std::vector<vectorlib::Vector2D<double>> points;
            for (int i = 0; i <= 20; ++i)
                points.push_back(moved.begin() + (moved.end() - moved.begin()) * (i / 20.0));
            const auto sums = vectorlib::TlsSums::of(points.begin(), points.end());
            map.emplace_back(std::int64_t(map.size()), vectorlib::EdgeRaw2D(sums, moved, 0), 4);
        }
        return map;
    }
    QString file(const char *name, const Map &map) const {
        std::ofstream out(path(name).toStdString());
        vectorlib::writeMapCsv(out, map);
        return path(name);
    }
    static double right(const std::vector<Wall> &walls) {
        double most = 0;
        for (const Wall &wall : walls)
            most = std::max(most, wall.end().x);
        return most;
    }
    /// The first `a` and the last `b` of a building, of its width.
    Result merge(const std::vector<Wall> &walls, double a, double b, const QStringList &more = {}) const {
        const double width = right(walls);
        const QString first = file("a.csv", mapOf(walls, -1, a * width, {}));
        const QString second = file("b.csv", mapOf(walls, (1 - b) * width, 2 * width, motion_.inverse()));
        QFile::remove(path("both.csv"));
        return run(QStringList{"map-merge", first, second, "--out", path("both.csv")} + more);
    }
    bool isRight(const Result &r) const {
        const QJsonObject t = json(r.out)["transformation"].toObject();
        return std::hypot(t["x"].toDouble() - motion_.x(), t["y"].toDouble() - motion_.y()) < 0.02 &&
               std::abs(t["theta"].toDouble() - motion_.alpha()) < 0.002;
    }

private Q_SLOTS:
    void init() { empty(); }

    void joinsWhereTheyOverlap() {
        for (const unsigned seed : {1u, 2u, 3u}) {
            const std::vector<Wall> walls = vectorlib::FloorPlan(seed, 16).walls();
            const Result r = merge(walls, 0.65, 0.65);
            QVERIFY2(r.status == 0, r.err.constData());
            QVERIFY2(isRight(r), r.out.constData());
            const QJsonObject told = json(r.out);
            QVERIFY(told["places_agree"].toInt() >= 3 && told["overlap_m"].toDouble() > 10);
            QVERIFY2(told["residual_rms_m"].toDouble() < 0.1, r.out.constData());
            std::istringstream text(contentOf(path("both.csv")).toStdString());
            const auto both = vectorlib::readMapCsv(text, "both");
            QVERIFY(bool(both));
            const std::size_t all = mapOf(walls, -1, 1e9, {}).size();
            QVERIFY2(both->size() <= all, "walls that both maps have stand twice");
            double points = 0;
            for (const vectorlib::MapEdge &edge : *both)
                points += edge.sums.n;
            const std::size_t given = mapOf(walls, -1, 0.65 * right(walls), {}).size() +
                                      mapOf(walls, 0.35 * right(walls), 1e9, {}).size();
            QCOMPARE(points, 21.0 * double(given)); // none is lost
        }
    }

    void refusesOtherBuildings() {
        for (const unsigned seed : {4u, 5u}) {
            const std::vector<Wall> one = vectorlib::FloorPlan(seed, 12).walls(),
                                    other = vectorlib::FloorPlan(seed + 10, 12).walls();
            const Result r = run({"map-merge", file("a.csv", mapOf(one, -1, 1e9, {})),
                                  file("b.csv", mapOf(other, -1, 1e9, {})), "--out", path("both.csv")});
            QVERIFY2(r.status == 1 && r.err.contains("not joined"), r.err.constData());
            QCOMPARE(r.out, QByteArray());
            QVERIFY(!QFile::exists(path("both.csv")));
        }
    }

    /// Rooms that only furniture tells apart: joined rightly or not at all.
    void foldsNothing() {
        int joined = 0;
        for (unsigned seed = 1; seed <= 6; ++seed) {
            const vectorlib::FloorPlan plan(seed, 16, vectorlib::FloorPlan::Rooms::Alike);
            for (const double part : {0.48, 0.65}) { // without and with an overlap
                const Result r = merge(plan.walls(), part, part);
                QVERIFY2(r.status == 1 || isRight(r), r.out.constData());
                joined += r.status == 0;
            }
        }
        qInfo("joined %d of 12", joined);
    }

    void operatorTellsWhere() {
        const std::vector<Wall> walls = vectorlib::FloorPlan(1, 12).walls();
        const Result r = merge(walls, 0.7, 0.7, {"--at", "3.2,-4.1,2.05"});
        QVERIFY2(r.status == 0 && isRight(r), r.err.constData());
        QCOMPARE(merge(walls, 0.7, 0.7, {"--at", "300,-4,2"}).status, 1);
        QCOMPARE(merge(walls, 0.7, 0.7, {"--at", "3,nan,2"}).status, 2);
    }

    void saysWhatIsWrong() {
        const QString map = file("a.csv", mapOf(vectorlib::FloorPlan(1, 4).walls(), -1, 1e9, {}));
        QCOMPARE(run({"map-merge", map, map}).status, 2); // where to
        QCOMPARE(run({"map-merge", map, map, "--out", path("both.txt")}).status, 2);
        QCOMPARE(run({"map-merge", map, path("none.csv"), "--out", path("both.csv")}).status, 1);
        QCOMPARE(files(), QStringList{"a.csv"});
    }
};
