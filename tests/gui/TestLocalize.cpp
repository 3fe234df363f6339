#include "tests/gui/SimulatedLog.h"
#include "tests/gui/VectorProgram.h"

/// hermes-vector map --localize: the poses of a drive in a finished map.
class TestLocalize : public QObject, protected TestFolder {
    Q_OBJECT

    std::mt19937 random_{4};
    RingBuilding building_{random_};
    std::vector<vectorlib::Pose2D> way_ = building_.drive(1);
    QString map_;

    QString logOf(const SimulatedLog &log, const char *name) const {
        put(path(name), log.text());
        return path(name);
    }
    Result localize(const QString &log, const QStringList &more = {}) const {
        return run(QStringList{"map", log, "--localize", map_, "--out-trajectory", path("tum"), "--force"} +
                   more);
    }
    /// The farthest pose from where it truly is in the map, which has the first pose as its origin; metres.
    static double farthest(const std::vector<vectorlib::Pose2D> &found,
                           const std::vector<vectorlib::Pose2D> &truth, const vectorlib::Pose2D &origin) {
        double most = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const vectorlib::Pose2D real = origin.inverse() * truth[i];
            most = std::max(most, std::hypot(found[i].x - real.x, found[i].y - real.y));
        }
        return most;
    }

private Q_SLOTS:
    void initTestCase() {
        const QString log = logOf(SimulatedLog(building_.world, way_, random_), "first");
        map_ = path("map.csv");
        ran({"map", log, "--out-map", map_});
    }

    void findsADriveFromItsMiddle() {
        const std::vector<vectorlib::Pose2D> part(way_.begin() + std::ptrdiff_t(way_.size() / 3), way_.end());
        const SimulatedLog log(building_.world, part, random_);
        const QByteArray before = contentOf(map_);
        const Result r = localize(logOf(log, "second"));
        QVERIFY2(r.status == 0, r.err.constData());
        const QJsonObject told = json(r.out);
        QVERIFY2(told["with_pose_share"].toDouble() > 0.99, r.out.constData());
        QCOMPARE(told["relocalized"].toInt(), 1);
        QCOMPARE(told["matched"].toInt() + told["lost"].toInt() + told["without_pose"].toInt(),
                 told["scans"].toInt());
        const auto found = posesOfTum(contentOf(path("tum")));
        QCOMPARE(found.size(), part.size());
        const double off = farthest(found, part, way_[0]);
        QVERIFY2(off < 0.1, saying(off));
        QCOMPARE(contentOf(map_), before);
        const QByteArray first = contentOf(path("tum"));
        QCOMPARE(localize(path("second")).status, 0);
        QCOMPARE(contentOf(path("tum")), first); // no clock has a say
    }

    /// The robot is lifted and set down elsewhere.
    void findsItAgain() {
        const auto at = [this](double share) {
            return way_.begin() + std::ptrdiff_t(share * double(way_.size()));
        };
        std::vector<vectorlib::Pose2D> ways(at(0.5), way_.end());
        ways.insert(ways.end(), at(0.35), at(0.75));
        const SimulatedLog log(building_.world, ways, random_);
        const Result r = localize(logOf(log, "second"));
        QVERIFY2(r.status == 0, r.err.constData());
        QVERIFY2(json(r.out)["with_pose_share"].toDouble() > 0.95, r.out.constData());
        const auto found = posesOfTum(contentOf(path("tum")));
        QCOMPARE(found.size(), ways.size());
        const double off = farthest(found, ways, way_[0]);
        QVERIFY2(off < 0.1, saying(off));
    }

    void refusesAnotherBuilding() {
        for (const unsigned seed : {21u, 22u, 23u}) {
            std::mt19937 random(seed);
            RingBuilding other(random);
            const SimulatedLog log(other.world, other.drive(1), random);
            QFile::remove(path("tum"));
            const Result r = localize(logOf(log, "foreign"));
            QVERIFY2(r.status == 1, r.out.constData());
            QVERIFY2(r.err.contains("foreign: not found in the map"), r.err.constData());
            QVERIFY(!QFile::exists(path("tum")));
            QCOMPARE(r.out, QByteArray());
        }
    }

    void takesNothingThatBuildsAMap() {
        const QString log = path("first");
        for (const QStringList &more :
             {QStringList{"--out-map", path("m.csv")}, QStringList{"--out-graph", path("g")},
              QStringList{"--loops", "leave"}, QStringList{"--scan", "1"}})
            QCOMPARE(localize(log, more).status, 2);
        put(path("empty.csv"), "id,x1,y1,x2,y2,n,sigma,observations,mean_x,mean_y,xx,xy,yy\n");
        const Result r = run({"map", log, "--localize", path("empty.csv")});
        QVERIFY2(r.status == 1 && r.err.contains("empty.csv: found a map without a wall"), r.err.constData());
    }
};
