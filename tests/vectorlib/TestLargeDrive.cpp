#include <vectorlib/graph/DriveRefiner.h>
#include <vectorlib/graph/MappedDrive.h>
#include <vectorlib/mapping/ScanTracker.h>

#include "tests/vectorlib/OfficeFloor.h"
#include "tests/vectorlib/RevisitError.h"

#include <numeric>

using namespace vectorlib;

/// Of the processor, as others may hold it up.
static double millisecondsSince(std::clock_t begin) {
    return 1000.0 * double(std::clock() - begin) / CLOCKS_PER_SEC;
}
/// Memory of this process; megabytes.
static double memory_MB() {
    QFile file("/proc/self/statm");
    if (!file.open(QIODevice::ReadOnly))
        return 0;
    return double(file.readAll().split(' ').value(1).toLongLong()) * double(sysconf(_SC_PAGESIZE)) / 1e6;
}
static double quantile(std::vector<double> values, double part) {
    if (values.empty())
        return 0;
    const auto at = values.begin() + std::ptrdiff_t(part * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}
static double sumOf(const std::vector<double> &values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Times of a stretch of the drive; milliseconds.
struct Times {
    std::vector<double> scan, correct;
};

/// A robot on slipping wheels that maps as it drives: as hermes-vector does, which makes the map anew at the
/// end, or as hermes-scanmatcher does, which makes it anew whenever the poses move.
class Mapping {
public:
    ScanTracker tracker;
    MappedDrive drive;
    DriveRefiner refine;
    Times times;
    bool live = false;

    void take(ScanWorld::Points points, const ScanWorld::Scanner &scanner, const Pose2D &wheels) {
        TimedScan scan = timedScan(std::move(points), scanner, double(drive.loops.scans()), wheels);
        const auto begin = std::clock();
        const Transformation2D pose(tracker.process(scan).pose);
        const Transformation2D motion = drive.loops.scans() == 0 ? pose : last_.inverse() * pose;
        last_ = pose;
        drive.add(scan.points, tracker.builder.edges(), motion, tracker.trackedBy());
        if (!live)
            refine.add(scan.points, motion);
        times.scan.push_back(millisecondsSince(begin));
        const auto corrected = std::clock();
        if (drive.loops.isDue()) {
            correct();
            times.correct.push_back(millisecondsSince(corrected));
        }
    }
    /// The poses of all scans.
    std::vector<Pose2D> finish() {
        drive.loops.correct();
        std::vector<Pose2D> poses = drive.loops.poses();
        if (!live)
            refine(poses, drive.loopsOfScans());
        drive.rebuild(tracker.builder, poses);
        drive.review(tracker.builder.map, poses);
        return poses;
    }

private:
    void correct() {
        const std::size_t last = drive.loops.scans() - 1;
        const Transformation2D before(drive.loops.pose(last));
        if (!drive.loops.correct() || !live)
            return;
        drive.rebuild(anew_);
        drive.review(anew_.map, drive.loops.poses());
        const Transformation2D moved = Transformation2D(drive.loops.pose(last)) * before.inverse();
        tracker.correct(anew_.map, moved);
        last_ = moved * last_;
    }

    Transformation2D last_;
    MapBuilder anew_;
};

/// A drive of many scans through a large floor: what it costs, and how that grows.
class TestLargeDrive : public QObject {
    Q_OBJECT

    static void tell(std::size_t scans, const Times &times, const Mapping &mapping) {
        qInfo("%7zu %7.2f %7.2f %8zu %10.2f %8.2f %8zu %7.1f", scans, quantile(times.scan, 0.5),
              quantile(times.scan, 0.99), times.correct.size(), quantile(times.correct, 1) / 1000,
              sumOf(times.correct) / 1000, mapping.tracker.builder.map.size(), memory_MB());
    }
    // Of the wheels, which slip by 3 % and turn by 0.003 rad a metre.
    static Transformation2D slipped(const Transformation2D &motion, std::mt19937 &random) {
        std::normal_distribution<double> noise;
        const double slip = 1 + 0.03 * noise(random);
        const double turn = 0.003 * std::sqrt(motion.translation().norm()) * noise(random);
        return {motion.x() * slip, motion.y() * slip, motion.alpha() + turn};
    }

private Q_SLOTS:
    void aScanCostsNoMoreAsTheDriveGrows_data() { falseAndTrue("live", "offline", "live"); }
    // HERMES_SCANS: how many. Tells what each twentieth of the drive cost.
    void aScanCostsNoMoreAsTheDriveGrows() {
        QFETCH(bool, live);
        const int asked = qEnvironmentVariableIntValue("HERMES_SCANS");
        const std::size_t scans = asked > 0 ? std::size_t(asked) : 2000;
        std::mt19937 random(7);
        OfficeFloor floor({200, 150}, random);
        const std::vector<Pose2D> way = floor.drive(scans, 0.64);
        const ScanWorld::Scanner scanner{361, 1.5 * pi, 0.02, 20};
        Mapping mapping;
        mapping.live = live;
        ScanTrackerSettings settings;
        settings.seekWhereContradicted = live; // else the map bends until the end
        mapping.tracker.apply(settings);
        mapping.tracker.place(way[0]);
        Transformation2D wheels(way[0]);
        std::vector<double> medians;
        double length = 0;
        qInfo("  scans  median    99 %% corrected longest, s   all, s    walls      MB");
        for (std::size_t i = 0; i < way.size(); ++i) {
            if (i > 0) {
                const Transformation2D motion = between(way[i - 1], way[i]);
                length += motion.translation().norm();
                wheels = wheels * slipped(motion, random);
            }
            mapping.take(floor.scan(Transformation2D(way[i]), scanner), scanner, wheels.pose());
            if ((i + 1) % (scans / 20) == 0) {
                tell(i + 1, mapping.times, mapping);
                medians.push_back(quantile(mapping.times.scan, 0.5));
                mapping.times = {};
            }
        }
        const auto begin = std::clock();
        const std::vector<Pose2D> poses = mapping.finish();
        const double finished = millisecondsSince(begin) / 1000;
        const LoopCounts counts = mapping.drive.loops.counts();
        const double error = revisitError(way, poses, std::max<std::size_t>(1, way.size() / 1000));
        qInfo("%.1f km; loops: %zu closed of %zu; the end: %.1f s, %zu walls, %.1f MB; error at revisits "
              "%.3f m",
              length / 1000, counts.closed, counts.tried, finished, mapping.tracker.builder.map.size(),
              memory_MB(), error);
        QVERIFY2(error < 0.05, saying("%1 m", error));
        QCOMPARE(mapping.tracker.counts().lost, 0U);
        const double first = sumOf({medians.begin(), medians.begin() + 5}) / 5;
        const double last = sumOf({medians.end() - 5, medians.end()}) / 5;
        QVERIFY2(last < 4 * first, saying("%1 ms, then %2 ms", first, last));
    }
};
