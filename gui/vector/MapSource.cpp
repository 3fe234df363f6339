#include "gui/vector/MapSource.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/Points.h"
#include "vectorlib/io/CarmenLog.h"

#include <algorithm>
#include <filesystem>

namespace hermes::vector {

namespace {

namespace fs = std::filesystem;

MapSourceReport readLog(const MapSourceOptions &options, const MapScanSink &sink) {
    Input input(options.path);
    vectorlib::CarmenOptions carmenOptions;
    carmenOptions.skipDamaged = options.skipDamaged;
    const vectorlib::CarmenLog log =
        valueOrFail(vectorlib::readCarmenLog(input.stream(), input.name(), carmenOptions));
    const auto kind =
        options.corrected ? vectorlib::CarmenOdometryKind::Corrected : vectorlib::CarmenOdometryKind::Raw;
    const std::size_t total = (log.scans.size() + options.every - 1) / options.every;
    MapScan scan;
    vectorlib::Transformation2D robot; // by odometry, since its last gap
    std::uint64_t epoch = 0;
    for (std::size_t i = 0; i < log.scans.size(); i += options.every) {
        const vectorlib::CarmenScan &source = log.scans[i];
        scan.points.clear();
        source.appendPoints(scan.points);
        scan.stamp = source.stamp;
        const auto motion = i > 0 ? log.odometryMotion(i - options.every, i, kind) : std::nullopt;
        if (motion)
            robot = robot * *motion;
        else
            ++epoch;
        scan.odometry.emplace(epoch,
                              std::vector<vectorlib::OdometrySample>{{source.stamp, robot.pose(), {}, {}}});
        if (options.corrected)
            scan.reference = source.laserPose;
        scan.rays = source.ranges.size();
        scan.fieldOfView = source.angleStep * double(source.ranges.size());
        scan.closed = scan.fieldOfView > 2 * vectorlib::pi - 1e-3;
        sink(scan, i / options.every, total);
    }
    MapSourceReport report;
    report.damagedLines = log.damaged;
    if (log.firstDamage)
        report.firstDamage = log.firstDamage->message();
    return report;
}

// The sensor counts clockwise, vectorlib the other way: the points of a turn are taken from the last to the
// first.
void takeTurn(const velodyne::Turn &turn, MapScan &scan) {
    scan.points.clear();
    scan.seconds.clear();
    for (auto p = turn.points.rbegin(); p != turn.points.rend(); ++p) {
        scan.points.emplace_back(float(p->x), float(p->y));
        scan.seconds.push_back(float(double(p->stamp_ns - turn.begin_ns) * 1e-9));
    }
    scan.stamp = double(turn.begin_ns) * 1e-9;
    scan.rays = turn.firings;
    scan.partial = turn.partial;
}

MapSourceReport readCapture(const MapSourceOptions &options, const MapScanSink &sink) {
    MapScan scan;
    std::size_t turns = 0;
    velodyne::TurnAssembler assembler({}, [&](const velodyne::Turn &turn) {
        if (turns++ % options.every != 0)
            return;
        takeTurn(turn, scan);
        sink(scan, (turns - 1) / options.every, 0);
    });
    MapSourceReport report;
    report.otherSensors = LidarCapture(options.path, options.sensor).read(assembler);
    return report;
}

MapSourceReport readFolder(const MapSourceOptions &options, const MapScanSink &sink) {
    std::vector<std::string> names;
    for (const fs::directory_entry &entry : fs::directory_iterator(options.path))
        if (entry.is_regular_file() &&
            (hasExtension(entry.path().string(), ".csv") || hasExtension(entry.path().string(), ".pcd")))
            names.push_back(entry.path().string());
    std::sort(names.begin(), names.end());
    if (names.empty())
        throw Failure(options.path + ": found no file *.csv or *.pcd, expected points files, one a scan");
    MapScan scan;
    scan.closed = !options.open;
    for (std::size_t i = 0; i < names.size(); i += options.every) {
        scan.points.clear();
        for (const auto &p : loadPoints(names[i]))
            scan.points.emplace_back(p);
        scan.stamp = double(i / options.every);
        sink(scan, i / options.every, (names.size() + options.every - 1) / options.every);
    }
    return {};
}

} // namespace

MapSourceReport readMapScans(const MapSourceOptions &options, const MapScanSink &sink) {
    std::error_code ignored;
    if (fs::is_directory(options.path, ignored))
        return readFolder(options, sink);
    return isCapture(options.path) ? readCapture(options, sink) : readLog(options, sink);
}

} // namespace hermes::vector
