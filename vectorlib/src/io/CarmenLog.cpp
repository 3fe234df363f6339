#include "vectorlib/io/CarmenLog.h"

#include <algorithm>
#include <initializer_list>
#include <tuple>
#include <utility>

namespace vectorlib {

VECTORLIB_BODY bool CarmenParameters::take(std::string_view name, std::string_view value) {
    std::string plain(name); // laser_front_laser_fov, laser_frontlaser_fov
    plain.erase(std::remove(plain.begin(), plain.end(), '_'), plain.end());
    using P = CarmenParameters;
    for (const auto &[known, target, least, most] :
         {std::tuple("robotfrontlasermax", &P::maxRange, 1e-3, 1e6),
          std::tuple("laserfrontlaserfov", &P::fieldOfView, 1e-3, 360.0),
          std::tuple("laserlaser1fov", &P::fieldOfView, 1e-3, 360.0),
          std::tuple("laserfrontlaserresolution", &P::resolution, 1e-3, 360.0),
          std::tuple("laserlaser1resolution", &P::resolution, 1e-3, 360.0),
          std::tuple("robotfrontlaseroffset", &P::offset, -100.0, 100.0),
          std::tuple("robotfrontlasersideoffset", &P::sideOffset, -100.0, 100.0),
          std::tuple("robotfrontlaserangularoffset", &P::angularOffset, -2 * pi, 2 * pi)})
        if (plain == known) {
            const auto number = parseNumber(value);
            if (!number || *number < least || *number > most)
                return false;
            this->*target = number;
        }
    return true;
}

VECTORLIB_BODY std::optional<double> CarmenParameters::angle(std::size_t rays) const {
    const auto steps = static_cast<double>(stepsOf(rays));
    const auto isOneOf = [rays](std::initializer_list<std::size_t> counts) {
        return std::find(counts.begin(), counts.end(), rays) != counts.end();
    };
    if (fieldOfView)
        return *fieldOfView / 180 * pi;
    if (resolution && *resolution * steps <= 360)
        return *resolution * steps / 180 * pi;
    if (isOneOf({180, 181, 360, 361, 720, 721})) // SICK LMS 2xx
        return pi;
    if (isOneOf({540, 541, 1080, 1081})) // SICK LMS 1xx, Hokuyo UTM-30LX
        return 1.5 * pi;
    if (isOneOf({682, 683, 725, 726, 768, 769})) // Hokuyo URG-04LX
        return steps / 512 * pi;
    return std::nullopt;
}

VECTORLIB_BODY std::optional<RepeatedRange> findRepeatedRange(const std::vector<CarmenScan> &scans) {
    constexpr float about = 0.998F; // causes differ by a few counts: 8.191, 8.183
    constexpr float similar = 0.8F;
    constexpr std::size_t leastRays = 10, directions = 5;
    std::vector<std::pair<float, std::size_t>> all; // returns and their rays, the largest first
    for (const CarmenScan &scan : scans)
        for (std::size_t i = 0; i < scan.ranges.size(); ++i)
            if (scan.isReturn(i))
                all.emplace_back(scan.ranges[i], i);
    std::sort(all.rbegin(), all.rend());
    const auto above = [&all](float least) { // how many are
        const auto is = [least](const auto &ray) { return ray.first > least; };
        return static_cast<std::size_t>(std::partition_point(all.begin(), all.end(), is) - all.begin());
    };
    const auto endOf = [&](std::size_t at) { return above(std::nextafter(all[at].first, 0.0F)); };
    for (std::size_t at = 0, end = 0; at < all.size(); at = end) {
        const float range = all[at].first;
        end = endOf(at);
        const std::size_t rays = end - at, beyond = above(range / about), from = above(range * about);
        if (beyond * 100 > all.size())
            break;
        if (rays < std::max(leastRays, all.size() / 500) || beyond * 20 > rays || rays * 20 > all.size() * 19)
            continue;
        std::size_t most = 0; // rays at one range of about this size
        for (std::size_t i = from, next = 0; i < above(range * similar); i = next)
            most = std::max(most, (next = endOf(i)) - i);
        if (most * 10 <= rays && all[at].second >= all[end - 1].second + directions)
            return RepeatedRange{range, double(range) * about, from};
    }
    return std::nullopt;
}

VECTORLIB_BODY std::optional<Transformation2D> CarmenLog::odometryMotion(std::size_t from, std::size_t to,
                                                                         CarmenOdometryKind kind) const {
    if (kind == CarmenOdometryKind::Raw && scans[from].hasOdometry && scans[to].hasOdometry)
        return Transformation2D(scans[from].robotPose).inverse() * Transformation2D(scans[to].robotPose);
    if (kind == CarmenOdometryKind::Raw)
        return std::nullopt;
    Transformation2D motion;
    for (std::size_t i = from + 1; i <= to; ++i) {
        if (!scans[i].wheelMotion)
            return std::nullopt;
        motion = motion * *scans[i].wheelMotion;
    }
    return motion;
}

VECTORLIB_BODY double CarmenLog::guessMaxRange() const {
    float largest = 0;
    for (const CarmenScan &scan : scans)
        for (const float range : scan.ranges)
            largest = std::max(largest, range);
    return largest >= 30 ? std::min(80.0, 0.998 * largest) : std::numeric_limits<double>::infinity();
}

VECTORLIB_BODY Pose2D CarmenLog::sensorOnRobot(CarmenOdometryKind kind) const {
    constexpr double farthest = 5, same = 1e-3, near = 0.05; // metres, radians
    if (kind == CarmenOdometryKind::Corrected)
        return {};
    std::vector<Pose2D> mounts;
    for (const CarmenScan &scan : scans)
        if (scan.hasOdometry)
            mounts.push_back(scan.robotPose.inverse() * scan.laserPose);
    const Pose2D mount = mounts.empty() ? Pose2D() : mounts[mounts.size() / 2];
    const auto isNear = [&mount](const Pose2D &other, double limit) {
        return std::hypot(mount.x - other.x, mount.y - other.y) < limit &&
               std::abs(wrapAngle(mount.theta - other.theta)) < limit;
    };
    const auto isLike = [&](const Pose2D &other) { return isNear(other, near); };
    const auto alike = static_cast<std::size_t>(std::count_if(mounts.begin(), mounts.end(), isLike));
    if (alike * 10 >= mounts.size() * 9 && !isNear({}, same) && std::hypot(mount.x, mount.y) < farthest)
        return mount;
    return {parameters.offset.value_or(0), parameters.sideOffset.value_or(0),
            parameters.angularOffset.value_or(0)};
}

VECTORLIB_BODY Expected<CarmenLog> detail::CarmenReader::read() {
    while (const auto line = lines_.next()) {
        if (const auto error = readLine(trimmed(*line))) {
            if (!options_.skipDamaged)
                return *error;
            if (log_.damaged++ == 0)
                log_.firstDamage = error;
        }
    }
    if (lines_.error())
        return *lines_.error();
    if (log_.scans.empty())
        return lines_.errorHere("the end of the log and no scan", "at least one line FLASER or ROBOTLASER1");
    describeScanner();
    return std::move(log_);
}

VECTORLIB_BODY void detail::CarmenReader::describeScanner() {
    CarmenParameters told = log_.parameters;
    if (options_.fieldOfView)
        told.fieldOfView = options_.fieldOfView;
    for (CarmenScan &scan : log_.scans) {
        const std::size_t rays = scan.ranges.size();
        const bool isFrontLaser = std::isinf(scan.maxRange); // which says neither
        if (isFrontLaser || options_.fieldOfView) {
            const auto angle = told.angle(rays);
            if (!angle)
                log_.assumedRays = rays;
            scan.startAngle = -angle.value_or(pi) / 2;
            scan.angleStep = angle.value_or(pi) / static_cast<double>(told.stepsOf(rays));
        }
        if (isFrontLaser && told.maxRange)
            scan.maxRange = *told.maxRange;
        scan.maxRange = options_.maxRange.value_or(scan.maxRange);
        if (options_.mirrored)
            mirror(scan);
    }
    if (!options_.maxRange)
        log_.noReturn = findRepeatedRange(log_.scans);
    const double repeated = log_.noReturn ? log_.noReturn->from : farthest, guessed = log_.guessMaxRange();
    for (CarmenScan &scan : log_.scans)
        scan.maxRange = std::min({std::isinf(scan.maxRange) ? guessed : scan.maxRange, repeated, farthest});
}

VECTORLIB_BODY void detail::CarmenReader::mirror(CarmenScan &scan) {
    scan.startAngle = -(scan.startAngle + scan.angleStep * (static_cast<double>(scan.ranges.size()) - 1));
    std::reverse(scan.ranges.begin(), scan.ranges.end());
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::readLine(std::string_view line) {
    if (line.empty() || line.front() == '#')
        return {};
    splitBlanks(line, fields_);
    const std::string_view keyword = fields_.front();
    if (keyword == "ODOM")
        return readOdometry();
    if (keyword == "FLASER" || keyword == "ROBOTLASER1") {
        Problem problem = keyword == "FLASER" ? readFrontLaser() : readRobotLaser();
        if (problem)
            interrupted();
        return problem;
    }
    const bool isKeyword = std::all_of(keyword.begin(), keyword.end(), [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
    if (!isKeyword || (!lines_.terminated() && fields_.size() == 1))
        return lines_.errorHere(vectorlib::quoted(keyword),
                                "a CARMEN message such as FLASER, ROBOTLASER1 or ODOM");
    const auto isPartOfName = [](char c) { return (c >= 'A' && c <= 'Z') || c == '_'; };
    for (const char *message : {"FLASER ", "ROBOTLASER1 ", "ODOM "})
        if (const auto at = line.find(message, 1);
            at != std::string_view::npos && !isPartOfName(line[at - 1]))
            return lines_.errorHere(vectorlib::quoted(line.substr(at)) + " in a line " + std::string(keyword),
                                    "one message a line");
    if (keyword == "PARAM")
        return readParameter();
    return {}; // NEFF, SYNC, RLASER, TRUEPOS and others tell nothing of the front laser
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::readParameter() {
    if (fields_.size() > 2 && !log_.parameters.take(fields_[1], fields_[2]))
        return lines_.errorHere(vectorlib::quoted(fields_[2]),
                                "a value of " + std::string(fields_[1]) +
                                    ": metres, degrees (fov, resolution) or radians (angular offset)");
    return {};
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::readOdometry() {
    CarmenOdometry odometry;
    odometry.line = lines_.number();
    if (fields_.size() != 10)
        return notOfLength("ODOM", 10);
    if (const auto problem = readPose(1, odometry.pose))
        return refuse(problem);
    if (const auto problem = readField(7, "the time stamp", odometry.stamp))
        return problem;
    follow(odometry.pose);
    log_.odometry.push_back(odometry);
    return {};
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::readFrontLaser() {
    CarmenScan scan;
    std::size_t at = 1;
    if (const auto problem = readRanges("FLASER", at, 9, scan))
        return problem;
    if (fields_.size() != at + 9)
        return notOfLength("FLASER", at + 9, scan.ranges.size());
    return finish(scan, at, at + 6);
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::readRobotLaser() {
    if (fields_.size() < 9)
        return notOfLength("ROBOTLASER1", 9);
    CarmenScan scan;
    double fieldOfView = 0;
    for (const auto &[index, what, value] : {std::tuple(2, "the start angle", &scan.startAngle),
                                             std::tuple(3, "the field of view", &fieldOfView),
                                             std::tuple(4, "the angular resolution", &scan.angleStep),
                                             std::tuple(5, "the maximum range", &scan.maxRange)})
        if (const auto problem = readField(index, what, *value))
            return problem;
    if (!(scan.angleStep > 0) || !(scan.maxRange > 0))
        return lines_.errorHere(vectorlib::quoted(fields_[scan.angleStep > 0 ? 5 : 4]),
                                "a resolution and a maximum range above 0");
    if (std::abs(scan.startAngle) > largestAngle || scan.angleStep > largestAngle)
        return lines_.errorHere(vectorlib::quoted(fields_[scan.angleStep > largestAngle ? 4 : 2]),
                                "a start angle and a resolution within a turn, in radians");
    scan.maxRange = std::min(scan.maxRange, farthest);
    std::size_t at = 8;
    if (const auto problem = readRanges("ROBOTLASER1", at, 15, scan))
        return problem;
    const std::size_t rays = scan.ranges.size();
    if (scan.angleStep * static_cast<double>(rays - 1) > widestScan)
        return lines_.errorHere(std::to_string(rays) + " rays " + std::string(fields_[4]) + " rad apart",
                                "rays within a turn");
    const auto remissions = parseCount(fields_[at], maxRays);
    if (!remissions)
        return lines_.errorHere(vectorlib::quoted(fields_[at]), "the number of remissions");
    at += 1 + *remissions;
    if (fields_.size() != at + 14)
        return notOfLength("ROBOTLASER1", at + 14, rays);
    return finish(scan, at, at + 11);
}

VECTORLIB_BODY detail::CarmenReader::Problem
detail::CarmenReader::readRanges(const char *keyword, std::size_t &at, std::size_t rest, CarmenScan &scan) {
    const auto count = fields_.size() > at ? parseCount(fields_[at], maxRays) : std::nullopt;
    if (!count || *count < 2)
        return lines_.errorHere(fields_.size() > at ? quoted(fields_[at]) : "the end of the line",
                                "the number of ranges, 2 to " + std::to_string(maxRays));
    if (fields_.size() < at + 1 + *count + rest)
        return notOfLength(keyword, at + 1 + *count + rest, *count);
    scan.ranges.reserve(*count);
    for (std::size_t i = 0; i < *count; ++i) {
        const auto range = parseAnyNumber(fields_[at + 1 + i]);
        if (!range)
            return lines_.errorHere(vectorlib::quoted(fields_[at + 1 + i]),
                                    "range " + std::to_string(i + 1) + " of " + std::to_string(*count) +
                                        ", a number of metres");
        const bool isReturn = std::isfinite(*range) && *range > 0;
        scan.ranges.push_back(isReturn ? static_cast<float>(std::min(*range, farthest)) : 0);
    }
    at += 1 + *count;
    return {};
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::finish(CarmenScan &scan, std::size_t poses,
                                                                          std::size_t stamp) {
    scan.line = lines_.number();
    if (const auto problem = readPosesOfScan(poses, scan))
        return problem;
    if (const auto problem = readField(stamp, "the time stamp", scan.stamp))
        return problem;
    // A single ODOM that repeats the pose of the scan before it tells nothing: the wheels were not asked
    // again.
    const bool told = last_ && (follows_ > 1 || last_->x != base_->x || last_->y != base_->y ||
                                last_->theta != base_->theta);
    if (told && !log_.scans.empty())
        scan.wheelMotion = moved_ * Transformation2D(*base_).inverse() * Transformation2D(*last_);
    moved_ = {};
    base_ = scan.laserPose;
    last_.reset();
    follows_ = 0;
    log_.scans.push_back(std::move(scan));
    return {};
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::readPosesOfScan(std::size_t at,
                                                                                   CarmenScan &scan) {
    Problem problem = readPose(at, scan.laserPose);
    if (problem && options_.refusesOdometry == CarmenOdometryKind::Corrected)
        return problem; // the reference
    if (!problem)
        problem = readPose(at + 3, scan.robotPose);
    if (!problem)
        return {};
    scan.hasOdometry = false;
    scan.robotPose = {};
    if (options_.refusesOdometry == CarmenOdometryKind::Raw)
        scan.laserPose = {};
    return refuse(problem);
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::refuse(const Problem &problem) {
    if (!options_.refusesOdometry)
        return problem;
    ++log_.odometryRefused;
    return {};
}

VECTORLIB_BODY void detail::CarmenReader::follow(const Pose2D &pose) {
    if (!base_)
        base_ = pose; // the first after a damaged scan: where the odometry restarted is not known but
                      // from here
    last_ = pose;
    ++follows_;
}

VECTORLIB_BODY void detail::CarmenReader::interrupted() {
    if (last_)
        moved_ = moved_ * Transformation2D(*base_).inverse() * Transformation2D(*last_);
    base_.reset();
    last_.reset();
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::readPose(std::size_t at, Pose2D &pose) {
    for (const auto &[offset, what, value] :
         {std::tuple(0u, "x of a pose", &pose.x), std::tuple(1u, "y of a pose", &pose.y),
          std::tuple(2u, "theta of a pose", &pose.theta)}) {
        if (const auto problem = readField(at + offset, what, *value))
            return problem;
        if (std::abs(*value) > widest)
            return lines_.errorHere(vectorlib::quoted(fields_[at + offset]),
                                    std::string(what) + " below 1e7");
    }
    return {};
}

VECTORLIB_BODY detail::CarmenReader::Problem detail::CarmenReader::readField(std::size_t at, const char *what,
                                                                             double &value) {
    const auto number = parseNumber(fields_[at]);
    if (!number)
        return lines_.errorHere(vectorlib::quoted(fields_[at]), std::string(what) + ", a finite number");
    value = *number;
    return {};
}

VECTORLIB_BODY InputError detail::CarmenReader::notOfLength(const char *keyword, std::size_t fields,
                                                            std::size_t ranges) const {
    const char *found = fields_.size() < fields ? "a line cut short after " : "a line that goes on to ";
    return lines_.errorHere(found + std::to_string(fields_.size()) + " fields",
                            std::to_string(fields) + " fields of " + keyword +
                                (ranges > 0 ? " with " + std::to_string(ranges) + " ranges" : ""));
}

} // namespace vectorlib
