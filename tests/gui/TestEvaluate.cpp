#include "tests/gui/VectorProgram.h"

#include "vectorlib/geometry/Transformation2D.h"

using vectorlib::Pose2D;
using vectorlib::Transformation2D;

/// hermes-vector evaluate: a trajectory beside the reference poses of a log.
class TestEvaluate : public QObject, protected TestFolder {
    Q_OBJECT

    using Drive = std::vector<Pose2D>;

    /// A log of the poses, a tenth of a second apart, and a trajectory of some of them.
    void writeLog(const Drive &drive) const {
        QByteArray text;
        for (std::size_t i = 0; i < drive.size(); ++i) {
            const QByteArray pose = numbers({drive[i].x, drive[i].y, drive[i].theta});
            text += "FLASER 3 1 1 1 " + pose + ' ' + pose + ' ' + numbers({stampOf(i)}) + " host " +
                    numbers({stampOf(i)}) + '\n';
        }
        put(path("a.log"), text);
    }
    void writeTrajectory(const Drive &drive, std::size_t every = 1) const {
        QByteArray text = "# stamp x y z qx qy qz qw\n";
        for (std::size_t i = 0; i < drive.size(); i += every)
            text += numbers({stampOf(i), drive[i].x, drive[i].y, 0, 0, 0, std::sin(drive[i].theta / 2),
                             std::cos(drive[i].theta / 2)}) +
                    '\n';
        put(path("a.tum"), text);
    }
    static double stampOf(std::size_t scan) { return 1000 + 0.1 * double(scan); }
    static QByteArray numbers(const std::vector<double> &values) {
        QByteArrayList list;
        for (const double v : values)
            list.append(QByteArray::number(v, 'g', 12));
        return list.join(' ');
    }
    Result evaluate(const QStringList &more = {}) const {
        return run(QStringList{"evaluate", path("a.log"), path("a.tum")} + more);
    }
    static Drive wandering(std::mt19937 &random, int poses) {
        std::uniform_real_distribution<double> step(0, 0.6), turn(-0.5, 0.5);
        Drive drive{{0, 0, 0}};
        for (int i = 1; i < poses; ++i) {
            const Pose2D &p = drive.back();
            const double length = step(random);
            const Pose2D next{p.x + length * std::cos(p.theta), p.y + length * std::sin(p.theta),
                              p.theta + turn(random)};
            const bool isInside = std::abs(next.x) < 8 && std::abs(next.y) < 8;
            drive.push_back(isInside ? next : Pose2D{p.x, p.y, p.theta + 0.7});
        }
        return drive;
    }
    static Drive moved(const Drive &drive, const Transformation2D &motion) {
        Drive result;
        for (const Pose2D &p : drive) {
            const Transformation2D m = motion * Transformation2D(p);
            result.push_back({m.x(), m.y(), m.alpha()});
        }
        return result;
    }

private Q_SLOTS:
    void init() { empty(); }

    // Against all pairs, one by one, as the rule says.
    void findsEveryPlaceMetAgain() {
        std::mt19937 random(newSeed());
        const Drive drive = wandering(random, 800);
        std::vector<double> way{0};
        for (std::size_t i = 1; i < drive.size(); ++i)
            way.push_back(way[i - 1] + std::hypot(drive[i].x - drive[i - 1].x, drive[i].y - drive[i - 1].y));
        int expected = 0;
        for (std::size_t k = 0; k < drive.size(); ++k)
            for (std::size_t i = 0; i + 40 <= k; ++i)
                expected += way[k] - way[i] >= 15 &&
                            std::hypot(drive[i].x - drive[k].x, drive[i].y - drive[k].y) < 2 &&
                            std::cos(drive[i].theta - drive[k].theta) > 0.5;
        QVERIFY(expected > 100);
        writeLog(drive);
        writeTrajectory(drive);
        const QJsonObject found = json(evaluate().out)["revisits"].toObject();
        QVERIFY2(std::abs(found["pairs"].toInt() - expected) <= 2, // numbers are rounded in the files
                 qPrintable(QString("%1 of %2").arg(found["pairs"].toInt()).arg(expected)));
    }

    void whereTheFramesLieDoesNotMatter() {
        std::mt19937 random(3);
        const Drive drive = wandering(random, 400);
        writeLog(drive);
        writeTrajectory(moved(drive, {100, -20, 2.5}));
        const QJsonObject found = json(evaluate().out);
        QCOMPARE(found["compared"].toInt(), 400);
        QVERIFY(found["consecutive"].toObject()["mean_m"].toDouble() < 1e-6);
        QVERIFY(found["revisits"].toObject()["mean_m"].toDouble() < 1e-6);
        QCOMPARE(found["revisits"].toObject()["within_10cm_2deg"].toDouble(), 1.0);
    }

    // Twice round the same square: the second time everything lies 30 cm aside.
    void tellsWhatIsOff() {
        Drive drive;
        for (int i = 0; i < 160; ++i) {
            const int side = i / 20 % 4;
            const double along = 0.5 * (i % 20), x[] = {along, 10, 10 - along, 0},
                         y[] = {0, along, 10, 10 - along};
            drive.push_back({x[side], y[side], side * 1.5707963267948966});
        }
        writeLog(drive);
        for (std::size_t i = 80; i < drive.size(); ++i)
            drive[i].y += 0.3;
        writeTrajectory(drive);
        const Result r = evaluate({"--svg", path("a.svg")});
        const QJsonObject found = json(r.out), again = found["revisits"].toObject();
        QVERIFY2(std::abs(again["mean_m"].toDouble() - 0.3) < 0.01, r.out.constData());
        QVERIFY(std::abs(again["percentile_95_m"].toDouble() - 0.3) < 1e-6);
        const QJsonObject next = found["consecutive"].toObject();
        QCOMPARE(next["motions"].toInt(), 159);
        QVERIFY(next["median_m"].toDouble() < 1e-6);
        QVERIFY(std::abs(next["mean_m"].toDouble() - 0.3 / 159) < 1e-6);
        const QByteArray svg = contentOf(path("a.svg"));
        isWellFormed(svg);
        QVERIFY(svg.contains("by 10 to 50 cm") && svg.contains("a.tum beside the reference of a.log"));
    }

    void fewerPosesAreTakenByTheirStamps() {
        std::mt19937 random(4);
        const Drive drive = wandering(random, 300);
        writeLog(drive);
        writeTrajectory(drive, 3);
        const QJsonObject found = json(evaluate().out);
        QCOMPARE(found["scans"].toInt(), 300);
        QCOMPARE(found["compared"].toInt(), 100);
        QCOMPARE(found["consecutive"].toObject()["motions"].toInt(), 99);
        QVERIFY(found["consecutive"].toObject()["mean_m"].toDouble() < 1e-6);
    }

    // As from a tracker that tells poses at its own rate.
    void morePosesThanScansAreTakenByTheNearest() {
        std::mt19937 random(6);
        const Drive drive = wandering(random, 200);
        writeLog(drive);
        QByteArray tum;
        for (std::size_t i = 0; i + 1 < drive.size(); ++i)
            for (int k = -10; k < 10; ++k) { // 200 Hz
                const double part = k / 20.0;
                const Pose2D &p = drive[i], &next = drive[k < 0 && i > 0 ? i - 1 : i + 1];
                const double x = p.x + std::abs(part) * (next.x - p.x),
                             y = p.y + std::abs(part) * (next.y - p.y);
                tum += numbers({stampOf(i) + 0.1 * part, x, y, 0, 0, 0, std::sin(p.theta / 2),
                                std::cos(p.theta / 2)}) +
                       '\n';
            }
        put(path("a.tum"), tum);
        const QJsonObject found = json(evaluate().out);
        QCOMPARE(found["compared"].toInt(), 199);
        QVERIFY(found["consecutive"].toObject()["mean_m"].toDouble() < 1e-6);
    }
    void posesOfOtherTimesAreNotTakenOneByOne() {
        std::mt19937 random(7);
        const Drive drive = wandering(random, 50);
        writeLog(drive);
        QByteArray tum;
        for (std::size_t i = 0; i < drive.size(); ++i)
            tum += numbers({1e6 + stampOf(i), drive[i].x, drive[i].y, 0, 0, 0, 0, 1}) + '\n';
        put(path("a.tum"), tum);
        const Result r = evaluate();
        QCOMPARE(r.status, 1);
        QVERIFY2(r.err.contains("0 of them at the time"), r.err.constData());
    }

    // At the same times, as many poses, a similar robot: only the way is another one.
    void theTrajectoryOfAnotherDriveIsRefused() {
        std::mt19937 random(8);
        for (const int poses : {30, 100, 1000}) {
            const Drive drive = wandering(random, poses);
            writeLog(drive);
            writeTrajectory(wandering(random, poses));
            const Result other = evaluate({"--svg", path("a.svg")});
            QCOMPARE(other.status, 1);
            QVERIFY2(other.err.contains("a.tum") && other.err.contains("a.log"), other.err.constData());
            QVERIFY2(other.err.contains("expected at most 70 %"), other.err.constData());
            QVERIFY(other.out.isEmpty() && !QFile::exists(path("a.svg")));
        }
    }
    // A drive that is bent: its turns are off by as much as 3 degrees a step, and by 15 degrees in ten
    // places.
    void aBadTrajectoryIsStillEvaluated() {
        std::mt19937 random(9);
        std::uniform_real_distribution<double> error(-0.05, 0.05);
        const Drive drive = wandering(random, 400);
        writeLog(drive);
        Drive bent = drive;
        double bend = 0;
        for (std::size_t i = 0; i < bent.size(); ++i) {
            bend += error(random) + (i % 40 == 0 ? 0.26 : 0);
            bent[i].theta += bend;
        }
        writeTrajectory(bent);
        const Result r = evaluate();
        QVERIFY2(r.status == 0, r.err.constData());
        QVERIFY(json(r.out)["revisits"].toObject()["mean_deg"].toDouble() > 3);
    }
    void fewPosesWithAScanMustTurnAsTheLogDoes_data() {
        const Rows<int, int, QByteArray> row("some", "status", "message");
        row("too few to tell", 10, 1, "found only 10 of 299 poses");
        row("a part of them", 60, 0, "only 60 of 299 poses");
        row("most of them", 200, 0, QByteArray());
    }
    // The others are between two scans, and one is missing, so that they are not taken one by one.
    void fewPosesWithAScanMustTurnAsTheLogDoes() {
        FETCH(int, some, int, status, QByteArray, message);
        std::mt19937 random(10);
        const Drive drive = wandering(random, 300);
        writeLog(drive);
        QByteArray tum;
        for (int i = 0; i + 1 < int(drive.size()); ++i) {
            const Pose2D &p = drive[std::size_t(i)];
            tum += numbers({stampOf(std::size_t(i)) + (i < some ? 0 : 0.05), p.x, p.y, 0, 0, 0,
                            std::sin(p.theta / 2), std::cos(p.theta / 2)}) +
                   '\n';
        }
        put(path("a.tum"), tum);
        const Result r = evaluate();
        QVERIFY2(r.status == status && r.err.contains(message), r.err.constData());
        QCOMPARE(r.err.isEmpty(), message.isEmpty());
    }

    // As in logs whose stamps were rounded: which scan a pose belongs to cannot be told.
    void tiedStampsTellNoScan() {
        std::mt19937 random(4);
        const Drive drive = wandering(random, 50);
        QByteArray log, tum;
        for (const Pose2D &p : drive)
            log += "FLASER 3 1 1 1 " + numbers({p.x, p.y, p.theta}) + ' ' + numbers({p.x, p.y, p.theta}) +
                   " 1000 host 1000\n";
        put(path("a.log"), log);
        for (std::size_t i = 0; i < drive.size(); i += 2)
            tum += numbers({1000 + 1e-6 * double(i), drive[i].x, drive[i].y, 0, 0, 0, 0, 1}) + '\n';
        put(path("a.tum"), tum);
        const Result r = evaluate();
        QCOMPARE(r.status, 1);
        QVERIFY2(r.err.contains("25 of 25 poses at the time of several scans"), r.err.constData());
    }

    void saysWhatIsWrong_data() {
        const Rows<QByteArray, QByteArray> row("trajectory", "message");
        row("empty", QByteArray(), "found 0 poses");
        row("other times", "1 0 0 0 0 0 0 1\n", "0 of them at the time");
        row("seven fields", "1 0 0 0 0 0 1\n", "7 fields");
        row("a word", "1 x 0 0 0 0 0 1\n", "\"x\"");
        row("not a number", "1 0 nan 0 0 0 0 1\n", "\"nan\"");
        row("no heading", "1 0 0 0 0 0 0 0\n", "quaternion");
        row("far away", "1 1e300 0 0 0 0 0 1\n", "beyond all measure");
    }
    void saysWhatIsWrong() {
        FETCH(QByteArray, trajectory, QByteArray, message);
        writeLog({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
        put(path("a.tum"), trajectory);
        const Result r = evaluate({"--svg", path("a.svg")});
        QCOMPARE(r.status, 1);
        QVERIFY2(r.err.contains("a.tum") && r.err.contains(message), r.err.constData());
        QVERIFY(!QFile::exists(path("a.svg")));
    }

    /// Of real buildings: with loops closed the places met again lie on each other.
    void loopsOfRealLogsAreClosed_data() {
        const Rows<double, double> row("tracked", "closed");
        row("intel", 0.5, 0.05);
        row("fhw", 0.3, 0.055);
        row("belgioioso", 0.05, 0.035);
        row("orebro", 1.0, 0.15); // has no odometry
    }
    void loopsOfRealLogsAreClosed() {
        FETCH(double, tracked, double, closed);
        REAL_DATA(log, QString("%1-corrected.log.gz").arg(QTest::currentDataTag()));
        const auto errorOf = [&](const char *loops) {
            const QString tum = path("real.tum");
            const Result r =
                run({"map", log, "--corrected", "--loops", loops, "--out-trajectory", tum, "--force"});
            const QJsonObject found = json(run({"evaluate", log, tum}).out)["revisits"].toObject();
            return r.status == 0 ? found["mean_m"].toDouble(1e9) : 1e9;
        };
        const double before = errorOf("leave"), after = errorOf("close");
        QVERIFY2(before > tracked && after < closed, saying("%1 to %2", before, after));
    }
    void thereIsNoGraphWithoutLoops() {
        writeLog({{0, 0, 0}, {1, 0, 0}});
        const Result r = run({"map", path("a.log"), "--loops", "leave", "--out-graph", path("a.g2o")});
        QCOMPARE(r.status, 2);
        QVERIFY2(r.err.contains("--out-graph") && r.err.contains("--loops close"), r.err.constData());
    }

    void aDriveThatNeverReturnsHasNoRevisits() {
        Drive drive;
        for (int i = 0; i < 60; ++i)
            drive.push_back({double(i), 0, 0});
        writeLog(drive);
        writeTrajectory(drive);
        const Result r = evaluate({"--svg", path("a.svg")});
        QCOMPARE(r.status, 0);
        QVERIFY(json(r.out)["revisits"].toObject()["mean_m"].isNull());
        QCOMPARE(json(r.out)["revisits"].toObject()["pairs"].toInt(), 0);
    }
};
