#include "gui/vector/MapSource.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "vectorlib/io/CarmenDrive.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/mapping/ScanPairMatcher.h"
#include "vectorlib/motion/ScannerCheck.h"

#include <algorithm>
#include <filesystem>
#include <tuple>
#include <utility>

namespace hermes::vector {

namespace {

namespace fs = std::filesystem;

// The name with zeros before its numbers, so that scan2 goes before scan10.
std::string orderOf(const std::string &name) {
    std::string key;
    for (std::size_t at = 0, end = 0; at < name.size(); at = end) {
        end = std::min(name.find_first_not_of("0123456789", at), name.size());
        key.append(end > at ? 30 - std::min<std::size_t>(30, end - at) : 0, '0');
        end = std::max(end, at + 1);
        key.append(name, at, end - at);
    }
    return key;
}

// secondsPerTurn: 0 where all points are of one moment; else the middle ray is measured at the stamp.
void takeLogged(const vectorlib::CarmenScan &source, double secondsPerTurn, vectorlib::TimedScan &scan) {
    scan.points.clear();
    source.appendPoints(scan.points);
    scan.seconds.clear();
    const double perRay = secondsPerTurn * source.angleStep / (2 * vectorlib::pi);
    const double middle = double(source.ranges.size() - 1) / 2;
    for (std::size_t i = 0; secondsPerTurn != 0 && i < source.ranges.size(); ++i)
        if (source.isReturn(i))
            scan.seconds.push_back(float((double(i) - middle) * perRay));
    scan.stamp = source.stamp;
    scan.rays = source.ranges.size();
    scan.fieldOfView = source.angleStep * double(source.ranges.size());
    scan.closed = scan.fieldOfView > 2 * vectorlib::pi - 1e-3;
}

// How long the scanner takes for a turn, by how the scans turn against the odometry; 0 where they do not
// tell.
double findSecondsPerTurn(const vectorlib::CarmenLog &log, vectorlib::CarmenOdometryKind kind,
                          const vectorlib::Pose2D &mount) {
    constexpr double least_rad = 0.02, most_rad = 0.5, longest_s = 1; // between two scans
    constexpr std::size_t enough = 2000;                              // pairs of scans
    vectorlib::ScannerCheck check;
    vectorlib::ScanPairMatcher match;
    match.settings.leavesOpen = false;
    vectorlib::CarmenDrive drive(log, kind, mount);
    vectorlib::TimedScan before, scan;
    for (std::size_t i = 0, pairs = 0; i < log.scans.size() && pairs < enough; ++i) {
        drive.advance();
        const auto last = scan.odometry;
        scan.odometry = drive.odometry();
        if (!last || !scan.odometry || last->epoch() != scan.odometry->epoch())
            continue;
        const double stamp = log.scans[i].stamp, stampBefore = log.scans[i - 1].stamp;
        const vectorlib::Transformation2D motion = last->at(stampBefore).inverse() * scan.odometry->at(stamp);
        const double turn = std::abs(motion.alpha()), seconds = stamp - stampBefore;
        if (turn < least_rad || turn > most_rad || !(seconds > 0) || seconds > longest_s)
            continue;
        takeLogged(log.scans[i - 1], 0, before);
        takeLogged(log.scans[i], 0, scan);
        match.extract.segment.settings = vectorlib::EarSettings::forScanner(scan.fieldOfView, scan.rays);
        match.extract.segment.settings.closed = scan.closed;
        const vectorlib::ScanPairMatch &found = match(before.points, scan.points, motion);
        ++pairs;
        if (found.accepted && found.linesSuffice)
            check.add(motion, found.pose, seconds);
    }
    return check.secondsPerTurn().value_or(0);
}

void readLog(Input &input, const MapSourceOptions &options, const MapScanSink &sink,
             MapSourceReport &report) {
    const auto kind =
        options.corrected ? vectorlib::CarmenOdometryKind::Corrected : vectorlib::CarmenOdometryKind::Raw;
    const vectorlib::CarmenLog log = valueOrFail(vectorlib::readCarmenLog(
        input.stream(), input.name(),
        {options.skipDamaged, kind, options.fieldOfView, options.maxRange, options.mirrored}));
    const vectorlib::Pose2D mount = options.mount.value_or(log.sensorOnRobot(kind));
    const std::size_t total = (log.scans.size() + options.every - 1) / options.every;
    const double perTurn =
        options.secondsPerTurn ? *options.secondsPerTurn : findSecondsPerTurn(log, kind, mount);
    MapScan scan;
    vectorlib::CarmenDrive drive(log, kind, mount);
    for (std::size_t i = 0; i < log.scans.size(); ++i) {
        drive.advance();
        if (i % options.every != 0)
            continue;
        takeLogged(log.scans[i], perTurn, scan);
        scan.odometry = drive.odometry();
        scan.fault = drive.isRepeated() ? MapScan::Fault::Repeated : MapScan::Fault::None;
        if (options.corrected)
            scan.reference = log.scans[i].laserPose;
        sink(scan, i / options.every, total);
    }
    report.damagedLines = log.damaged;
    report.odometryRefused = log.odometryRefused;
    report.odometryLeaps = drive.leaps();
    report.noReturn = log.noReturn;
    report.assumedRays = log.assumedRays;
    report.mount = mount;
    report.secondsPerTurn = perTurn;
    report.isTurnTold = options.secondsPerTurn.has_value();
    if (log.firstDamage)
        report.firstDamage = log.firstDamage->message();
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
    scan.fault = turn.partial ? MapScan::Fault::Partial : MapScan::Fault::None;
}

void reportSession(const RecordedSession &session, bool isCapture, const MapSourceOptions &options,
                   MapSourceReport &report) {
    report.odometryRefused = session.refused();
    report.mount = options.mount.value_or(session.tracker().sensorOnRobot);
    auto [first, second, left] = session.scanTopics();
    if (isCapture && !second.empty())
        left += (left.empty() ? "" : ", ") + std::exchange(second, "");
    for (const std::string &text :
         {second.empty() ? "" : first + " and " + second + " are two scanners of one robot",
          left.empty() ? "" : "left out: " + left, session.problems()})
        if (!text.empty())
            report.otherSensors += (report.otherSensors.empty() ? "" : "; ") + text;
}

void readCapture(Input &input, const MapSourceOptions &options, const MapScanSink &sink,
                 MapSourceReport &report) {
    MapScan scan;
    std::size_t turns = 0;
    RecordedSession *const session = options.session.get();
    const auto decoding = session ? session->decoding() : velodyne::TurnAssembler::Options();
    velodyne::TurnAssembler assembler(decoding, [&](const velodyne::Turn &turn) {
        if (turns++ % options.every != 0)
            return;
        takeTurn(turn, scan);
        if (session && session->isUpsideDown())
            scan.turnOver();
        if (session && !scan.points.empty())
            scan.odometry = session->over(scan.begin(), scan.end());
        sink(scan, (turns - 1) / options.every, 0);
    });
    report.otherSensors = LidarCapture(input, options.sensor, velodyne::Model::Blank,
                                       session ? session->clock() : velodyne::ClockChoice::Gps)
                              .read(assembler);
    if (session)
        reportSession(*session, true, options, report);
}

/// Of a session whose scanner has no capture: the scans that its daemon published.
void readScans(const MapSourceOptions &options, const MapScanSink &sink, MapSourceReport &report) {
    RecordedSession &session = *options.session;
    std::size_t scans = 0;
    MapScan scan;
    session.readScans([&](const vectorlib::TimedScan &read, bool partial) {
        if (scans++ % options.every != 0)
            return;
        static_cast<vectorlib::TimedScan &>(scan) = read;
        scan.fault = partial ? MapScan::Fault::Partial : MapScan::Fault::None;
        if (!scan.points.empty())
            scan.odometry = session.over(scan.firstSeen(), scan.lastSeen());
        sink(scan, (scans - 1) / options.every, 0);
    });
    reportSession(session, false, options, report);
}

void readBag(const MapSourceOptions &options, const MapScanSink &sink, MapSourceReport &report) {
    BagDrive &bag = *options.bag;
    const std::size_t total = (std::size_t(bag.scanner().messages) + options.every - 1) / options.every;
    std::size_t scans = 0;
    MapScan scan;
    bag.readScans([&](const vectorlib::TimedScan &read) {
        if (scans++ % options.every != 0)
            return;
        static_cast<vectorlib::TimedScan &>(scan) = read;
        scan.fault = MapScan::Fault::None;
        sink(scan, (scans - 1) / options.every, total);
    });
    report.odometryRefused = bag.odometryRefused();
    report.mount = options.mount ? *options.mount : bag.scanner().mount.value_or(vectorlib::Pose2D());
    report.otherSensors = bag.notices(options.mount.has_value());
    if (!options.mount && !bag.scanner().mount)
        report.otherSensors += "; --sensor X,Y,THETA tells where";
}

void readFolder(const MapSourceOptions &options, const MapScanSink &sink) {
    std::vector<std::string> names;
    for (const fs::directory_entry &entry : fs::directory_iterator(fs::u8path(options.path)))
        if (entry.is_regular_file() &&
            (hasExtension(entry.path().u8string(), ".csv") || hasExtension(entry.path().u8string(), ".pcd")))
            names.push_back(entry.path().u8string());
    std::sort(names.begin(), names.end(), [](const std::string &a, const std::string &b) {
        return std::pair(orderOf(a), a) < std::pair(orderOf(b), b);
    });
    if (names.empty())
        throw Failure(options.path +
                      (fs::exists(fs::u8path(options.path) / "scanner-scan.raw")
                           ? ": found a recording of hermes-scanner, expected a session of "
                             "hermes-recorder, whose recorder-0001.mcap has the scans"
                           : ": found no file *.csv or *.pcd, expected points files, one a scan"));
    MapScan scan;
    scan.closed = !options.open;
    for (std::size_t i = 0; i < names.size(); i += options.every) {
        scan.points.clear();
        scan.fault = MapScan::Fault::None;
        for (const auto &p : loadPoints(names[i]))
            scan.points.emplace_back(p);
        scan.stamp = double(i / options.every);
        sink(scan, i / options.every, (names.size() + options.every - 1) / options.every);
    }
}

/// Options that say nothing of what is read.
void refuseUnused(const MapSourceOptions &options, bool isCapture, bool isLog) {
    for (const auto &[option, what, isUnused] :
         {std::tuple("--port", "capture", !isCapture && options.sensor.port),
          std::tuple("--sender", "capture", !isCapture && !options.sensor.sender.empty()),
          std::tuple("--corrected", "CARMEN log", !isLog && options.corrected),
          std::tuple("--skip-damaged", "CARMEN log", !isLog && options.skipDamaged),
          std::tuple("--topic, --laser and --height", "bag", !options.bag && options.scanner.isGiven()),
          std::tuple("--sensor", "CARMEN log, session or bag",
                     !isLog && !options.session && !options.bag && options.mount),
          std::tuple("--field-of-view", "CARMEN log", !isLog && options.fieldOfView),
          std::tuple("--max-range", "CARMEN log", !isLog && options.maxRange),
          std::tuple("--seconds-per-turn", "CARMEN log", !isLog && options.secondsPerTurn),
          std::tuple("--mirrored", "CARMEN log", !isLog && options.mirrored)})
        if (isUnused)
            throw CLI::ValidationError(option, std::string("only of a ") + what + ", and " + options.path +
                                                   " is none");
}

void readAny(const MapSourceOptions &options, const MapScanSink &sink, MapSourceReport &report) {
    std::error_code ignored;
    if (options.bag) {
        refuseUnused(options, false, false);
        return readBag(options, sink, report);
    }
    if (options.session) {
        const auto capture =
            fs::is_directory(fs::u8path(options.path), ignored) ? captureIn(options.path) : std::nullopt;
        refuseUnused(options, capture.has_value(), false);
        if (!capture)
            return readScans(options, sink, report);
        Input input(*capture);
        return readCapture(input, options, sink, report);
    }
    if (fs::is_directory(fs::u8path(options.path), ignored)) {
        refuseUnused(options, false, false);
        return readFolder(options, sink);
    }
    Input input(options.path);
    refuseUnused(options, input.isCapture(), !input.isCapture());
    input.isCapture() ? readCapture(input, options, sink, report) : readLog(input, options, sink, report);
}

} // namespace

MapSourceReport readMapScans(const MapSourceOptions &options, const MapScanSink &sink) {
    using Fault = MapScan::Fault;
    MapSourceReport report;
    std::optional<double> last;
    const auto take = [&](MapScan &scan, std::size_t number, std::size_t total) {
        if (scan.fault == Fault::None && scan.points.empty())
            scan.fault = Fault::Empty;
        report.repeated += scan.fault == Fault::Repeated;
        report.empty += scan.fault == Fault::Empty;
        if (scan.fault != Fault::Repeated) {
            report.stampsBack += last && scan.stamp < *last;
            last = scan.stamp;
        }
        sink(scan, number, total);
    };
    readAny(options, take, report);
    return report;
}

nlohmann::ordered_json MapSourceReport::summary() const {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const auto &[key, count] :
         {std::pair("damaged_lines", damagedLines), std::pair("duplicated", repeated),
          std::pair("empty", empty), std::pair("stamps_back", stampsBack),
          std::pair("odometry_refused", odometryRefused), std::pair("odometry_leaps", odometryLeaps)})
        if (count > 0)
            json[key] = count;
    if (mount.x != 0 || mount.y != 0 || mount.theta != 0)
        json["sensor"] = {vectorlib::micrometres(mount.x), vectorlib::micrometres(mount.y), mount.theta};
    if (secondsPerTurn != 0)
        json["seconds_per_turn"] = secondsPerTurn;
    return json;
}

void MapSourceReport::warn(std::ostream &out) const {
    const auto tell = [&out](std::size_t count, const std::string &text) {
        if (count > 0)
            out << "hermes-vector: " << count << ' ' << text << '\n';
    };
    tell(damagedLines, "damaged line(s) left out, the first: " + firstDamage);
    tell(repeated, "scan(s) left out that repeat one shortly before, stamp and ranges");
    tell(empty, "scan(s) left out in which no ray has a return");
    tell(stampsBack,
         "scan(s) have a stamp before that of the last one: they are taken in the order of the log");
    tell(odometryRefused, "pose(s) of the odometry refused: expected finite numbers below 1e7");
    tell(odometryLeaps, "motion(s) of the odometry refused: no robot drives or turns that fast");
    if (noReturn)
        out << "hermes-vector: " << vectorlib::Number(vectorlib::rounded(noReturn->range, 4)) << " m, in "
            << noReturn->rays
            << " rays, is no wall: it is taken as no return (--max-range M tells the longest range)\n";
    if (assumedRays > 0)
        out << "hermes-vector: FLASER with " << assumedRays
            << " rays does not tell its field of view: 180 degrees are assumed (--field-of-view DEG)\n";
    if (secondsPerTurn != 0 && !isTurnTold)
        out << "hermes-vector: a turn of the scanner takes "
            << vectorlib::Number(vectorlib::rounded(secondsPerTurn, 3))
            << " s, as the turns of the robot tell: each point gets its time (--seconds-per-turn S)\n";
    if (!otherSensors.empty())
        out << "hermes-vector: " << printable(otherSensors) << '\n';
}

} // namespace hermes::vector
