#include "tests/gui/SimulatedLog.h"
#include "tests/gui/VectorProgram.h"

/// hermes-vector map with logs that are spoiled: what is wrong is counted and told, and the map stays good.
class TestBadLogs : public QObject, protected TestFolder {
    Q_OBJECT

    std::mt19937 random_;

    std::size_t any(std::size_t count) { return random_() % count; }
    /// A scan after the first ones.
    std::size_t drawn(const SimulatedLog &log) { return 5 + any(log.lines.size() - 10); }
    int spoil(SimulatedLog &log, const QString &kind) {
        constexpr int times = 8;
        if (kind == "duplicated") {
            for (int i = 0; i < times; ++i) {
                const std::size_t at = drawn(log);
                SimulatedLog::Line copy = log.lines[at];
                copy.counts = false;
                log.lines.insert(log.lines.begin() + std::ptrdiff_t(at + 1 + any(3)), copy);
            }
        } else if (kind == "empty") {
            for (int i = 0; i < times; ++i) {
                const std::size_t at = drawn(log);
                SimulatedLog::Line none = log.lines[at];
                std::fill(none.ranges.begin(), none.ranges.end(), i % 2 == 0 ? 0 : 81.91);
                none.stamp += 0.1;
                none.counts = false;
                log.lines.insert(log.lines.begin() + std::ptrdiff_t(at + 1), none);
            }
        } else if (kind == "stamps_back") {
            for (std::size_t i = drawn(log); i < log.lines.size(); ++i) // the clock was set
                log.lines[i].stamp -= 3600;
            return 1;
        } else if (kind == "odometry_refused") {
            for (int i = 0; i < times; ++i)
                log.lines[drawn(log)].odometry = i % 3 == 0   ? "nan nan nan"
                                                 : i % 3 == 1 ? "1 inf 0"
                                                              : "1e9 0 0";
        } else if (kind == "odometry_leaps") {
            const std::size_t from = drawn(log), once = drawn(log);
            for (std::size_t i = 0; i < log.lines.size(); ++i) {
                const QList<QByteArray> f = log.lines[i].odometry.split(' ');
                const double leap = (i >= from ? 100 : 0) + (i == once ? 70 : 0);
                if (f[0] != "nan" && leap > 0)
                    log.lines[i].odometry =
                        QByteArray::number(f[0].toDouble() + leap, 'f', 6) + ' ' + f[1] + ' ' + f[2];
            }
            return 1; // the second may hit a scan that is left out
        }
        return times / 2; // two may hit the same scan
    }

private Q_SLOTS:
    void init() { empty(); }

    void isToldAndDoesNoHarm_data() {
        const Rows<QStringList> row("kinds");
        const QStringList all{"duplicated", "empty", "stamps_back", "odometry_refused", "odometry_leaps"};
        row("good", QStringList());
        for (const QString &kind : all)
            row(qPrintable(kind), {kind});
        std::mt19937 random(7);
        for (int i = 0; i < 4; ++i) {
            QStringList some;
            for (const QString &kind : all)
                if (random() % 3 > 0)
                    some << kind;
            row(qPrintable("drawn " + some.join(", ")), some);
        }
        row("all", all);
    }
    void isToldAndDoesNoHarm() {
        QFETCH(QStringList, kinds);
        for (const unsigned seed : {1u, 2u}) {
            random_.seed(seed);
            RingBuilding building(random_);
            SimulatedLog log(building.world, building.drive(2), random_);
            std::map<QString, int> least;
            for (const QString &kind : kinds)
                least[kind] = spoil(log, kind);
            put(path("log"), log.text());
            const Result r = ran({"map", path("log"), "--out-trajectory", path("tum"), "--out-map",
                                  path("map.csv"), "--force"});
            const QJsonObject told = json(r.out);
            for (const char *kind :
                 {"duplicated", "empty", "stamps_back", "odometry_refused", "odometry_leaps"}) {
                const bool isThere = kinds.contains(kind);
                QVERIFY2(told.contains(kind) == isThere || QByteArray(kind) == "stamps_back",
                         r.out.constData());
                QVERIFY2(told[kind].toInt() >= least[kind], r.out.constData());
            }
            if (kinds.isEmpty())
                QCOMPARE(r.err, QByteArray());
            QCOMPARE(told["scans"].toInt(), int(log.lines.size()));
            const std::vector<vectorlib::Pose2D> found = posesOfTum(contentOf(path("tum")));
            QCOMPARE(found.size(), log.truth().size());
            const RevisitErrors errors(found, log.truth());
            const QString text =
                QString("seed %1: mean %2 m, worst %3 m").arg(seed).arg(errors.mean).arg(errors.worst);
            QVERIFY2(errors.pairs > 20 && errors.worst < 0.1, qPrintable(text));
        }
    }

    void oddScanIsAScan() {
        random_.seed(3);
        RingBuilding building(random_);
        SimulatedLog log(building.world, building.drive(1), random_);
        log.lines.resize(4);
        log.lines[2] = log.lines[1];
        put(path("log"), log.text());
        const Result scan = ran({"map", path("log"), "--scan", "2"});
        QCOMPARE(scan.out, run({"map", path("log"), "--scan", "1"}).out);
        QVERIFY(scan.err.contains("1 scan(s) left out that repeat"));
    }
};
