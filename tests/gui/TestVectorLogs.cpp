#include "tests/gui/VectorProgram.h"

#include <vectorlib/geometry/Pose2D.h>

using vectorlib::Pose2D;

/// What hermes-vector map makes of logs whose robots, scanners and coordinates are not the ordinary ones.
class TestVectorLogs : public QObject, protected TestFolder {
    Q_OBJECT

    using Poses = std::pair<Pose2D, Pose2D>; ///< laser, robot
    static constexpr Pose2D mount{-0.2, 0.1, 3};

    /// raw.log or corrected.log with other poses.
    QString changed(const char *name, const std::function<Poses(const Pose2D &)> &poses) {
        QByteArrayList lines;
        for (const QByteArray &line : contentOf(data(name)).split('\n')) {
            QByteArrayList fields = line.simplified().split(' ');
            const bool isScan = fields[0] == "FLASER";
            if (!isScan && fields[0] != "ODOM")
                continue;
            const int at = isScan ? fields[1].toInt() + 2 : 1;
            const auto [laser, robot] =
                poses({fields[at].toDouble(), fields[at + 1].toDouble(), fields[at + 2].toDouble()});
            int i = at;
            for (const double value : {laser.x, laser.y, laser.theta, robot.x, robot.y, robot.theta})
                if (i < at + (isScan ? 6 : 3))
                    fields[i++] = QByteArray::number(value, 'f', 6);
            lines += fields.join(' ');
        }
        put(path(name), lines.join('\n') + '\n');
        return path(name);
    }
    QList<Pose2D> trajectory(const QStringList &arguments, QJsonObject *summary = nullptr) {
        const Result r = ran(QStringList{"map", "--out-trajectory", path("t.tum"), "--force"} + arguments);
        if (summary != nullptr)
            *summary = json(r.out);
        QList<Pose2D> poses;
        for (const QByteArray &line : contentOf(path("t.tum")).trimmed().split('\n')) {
            const QList<QByteArray> f = line.split(' ');
            poses += {f[1].toDouble(), f[2].toDouble(), 2 * std::atan2(f[6].toDouble(), f[7].toDouble())};
        }
        return poses;
    }
    static double farthest(const QList<Pose2D> &a, const QList<Pose2D> &b, const Pose2D &offset = {}) {
        double most = a.size() == b.size() ? 0 : INFINITY;
        for (int i = 0; i < std::min(a.size(), b.size()); ++i)
            most = std::max(most, std::hypot(a[i].x + offset.x - b[i].x, a[i].y + offset.y - b[i].y));
        return most;
    }

private Q_SLOTS:
    void init() { empty(); }

    void aSensorMountedOtherwise_data() {
        const Rows<bool, QStringList, bool> row("isTold", "options", "isKnown");
        row("the log tells", true, {}, true);
        row("an option tells", false, {"--sensor", "-0.2,0.1,3"}, true);
        row("in degrees", false, {"--sensor", "-0.2, 0.1, 171.88734deg"}, true);
        row("an option goes before the log", true, {"--sensor=-0.2,0.1,0"}, false);
        row("nothing tells", false, {}, false);
    }
    /// The laser moves as in raw.log; the odometry is that of the robot below it.
    void aSensorMountedOtherwise() {
        FETCH(bool, isTold, QStringList, options, bool, isKnown);
        const QString log = changed("raw.log", [isTold](const Pose2D &laser) {
            const Pose2D robot = laser * mount.inverse();
            return Poses(isTold ? laser : robot, robot);
        });
        ran({"map", data("raw.log"), "--out-map", path("m.csv")});
        for (const QStringList &way : {QStringList(), QStringList{"--localize", path("m.csv")}}) {
            QJsonObject summary;
            const QList<Pose2D> poses = trajectory(QStringList{log} + options + way, &summary);
            QCOMPARE(summary["sensor"].toArray().size(), isTold || !options.isEmpty() ? 3 : 0);
            QCOMPARE(summary.contains("contradicted"), !isKnown);
            QVERIFY(!isKnown || farthest(poses, trajectory(QStringList{data("raw.log")} + way)) < 1e-4);
        }
    }
    void aContradictionIsTold() {
        const Result r = ran({"map", data("raw.log"), "--sensor", "0,0,180deg"});
        const QByteArray times = QByteArray::number(json(r.out)["contradicted"].toInt());
        QVERIFY2(r.err.contains("odometry and scans contradict each other " + times + " time(s): "),
                 r.err.constData());
        QVERIFY(!ran({"map", data("raw.log")}).err.contains("contradict"));
        QVERIFY(!ran({"map", data("raw.log"), "--sensor", "0,0,180deg", "--odometry", "ignore"})
                     .err.contains("contradict"));
    }

    void whatTheScannerIsSaidToBe() {
        const Result wide = ran({"map", data("raw.log"), "--scan", "1", "--field-of-view", "120"});
        QVERIFY(std::abs(wide.out.split('\n')[1].split(',')[1].toDouble() + 1.54 * std::sin(M_PI / 3)) <
                1e-3);
        const Result near = ran({"map", data("raw.log"), "--scan", "1", "--max-range", "1.6"});
        for (const QByteArray &point : near.out.trimmed().split('\n').mid(1))
            QVERIFY(std::hypot(point.split(',')[0].toDouble(), point.split(',')[1].toDouble()) < 1.6);
        put(path("odd.log"), "FLASER 3 1 2 1 0 0 0 0 0 0 1 h 1\n");
        QVERIFY(ran({"map", path("odd.log")}).err.contains("180 degrees are assumed (--field-of-view DEG)"));
        QVERIFY(!ran({"map", path("odd.log"), "--field-of-view", "180"}).err.contains("assumed"));
    }
    /// 16 m everywhere that nothing is, and walls nearer than 4 m.
    void aRangeOfManyRaysIsTold() {
        QByteArray log;
        for (int scan = 0; scan < 5; ++scan) {
            log += "FLASER 181";
            for (int ray = 0; ray < 181; ++ray)
                log += ray % 4 == 0 ? " 16" : ' ' + QByteArray::number(2 + 0.01 * ((ray * 7 + scan) % 180));
            log += " 0 0 0 0 0 0 " + QByteArray::number(scan) + " h 1\n";
        }
        put(path("in.log"), log);
        const QByteArray said = ran({"map", path("in.log")}).err;
        QVERIFY2(said.contains("16 m, in 230 rays, is no wall"), said.constData());
        QVERIFY(!ran({"map", path("in.log"), "--max-range", "20"}).err.contains("is no wall"));
    }

    void aMapInUtmIsReadAgain() {
        const Pose2D offset{691608.9, 5334760.25, 0};
        const QString log = changed("corrected.log", [&offset](const Pose2D &pose) {
            const Pose2D there{pose.x + offset.x, pose.y + offset.y, pose.theta};
            return Poses(there, there);
        });
        const QList<Pose2D> here = trajectory({data("corrected.log"), "--corrected"});
        const QList<Pose2D> there = trajectory({log, "--corrected", "--out-map", path("m.csv")});
        QVERIFY(farthest(here, there, offset) < 1e-5);
        ran({"map", log, "--scan", "5", "--out", path("s.csv")});
        const QJsonObject found = json(ran({"relocalize", path("m.csv"), path("s.csv")}).out);
        const QJsonObject pose = found["places"].toArray()[0].toObject()["pose"].toObject();
        QVERIFY(std::hypot(pose["x"].toDouble() - there[5].x, pose["y"].toDouble() - there[5].y) < 0.05);
    }

    void aFolderIsTakenByItsNumbers() {
        QVERIFY(QDir(path("")).mkpath("scans"));
        for (int i = 1; i <= 11; ++i)
            ran({"observe", data("world.json"), "--pose", QStringLiteral("%1,0,0").arg(0.05 * i), "--scan",
                 "400", "--out", path(qPrintable(QStringLiteral("scans/scan%1.csv").arg(i))), "--force"});
        const QList<Pose2D> poses = trajectory({path("scans")});
        QCOMPARE(poses.size(), 11);
        for (int i = 0; i < 11; ++i)
            QVERIFY(std::abs(poses[i].x - 0.05 * i) < 0.01);
    }
    /// Rays without return among the points are no points.
    void pointsOfNoReturn() {
        put(path("nan.csv"), contentOf(data("room.csv")).replace("x,y\n", "x,y\nnan,nan\ninf,1\n"));
        QCOMPARE(ran({"segment", path("nan.csv")}).out, ran({"segment", data("room.csv")}).out);
    }

    void theYamlNamesThePicture() {
        ran({"map", data("raw.log"), "--out-map", path("a: #2.pgm")});
        QVERIFY(contentOf(path("a: #2.yaml")).startsWith("image: \"a: #2.pgm\"\n"));
    }
};
