#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/io/TextInput.h"
#include "vectorlib/motion/Odometry.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace vectorlib {

/// A line `ODOM x y theta tv rv accel ipc_timestamp host logger_timestamp`; metres, radians, seconds.
struct CarmenOdometry {
    std::size_t line = 0;
    double stamp = 0;
    Pose2D pose;
};

/// A line FLASER or ROBOTLASER1: one scan, counter-clockwise; metres, radians, seconds.
struct CarmenScan {
    std::size_t line = 0;
    double stamp = 0;
    double startAngle = 0; ///< of the first ray, in the sensor's frame
    double angleStep = 0;
    /// Ranges from here on mean no return. FLASER does not say it: CarmenParameters::maxRange or
    /// CarmenLog::guessMaxRange fill it in.
    double maxRange = std::numeric_limits<double>::infinity();
    std::vector<float> ranges; ///< every ray; 0 where the log has inf, nan or a negative number
    Pose2D laserPose;          ///< first triple; the reference pose in corrected logs
    Pose2D robotPose;          ///< second triple; the odometry in ordinary logs
    /// Motion since the previous scan by the ODOM lines between them, begun at the previous scan's pose as
    /// corrected logs write it. Never holds this scan's own pose. Nothing when no ODOM line stands between
    /// that says more than the scan itself.
    std::optional<Transformation2D> wheelMotion;
    bool hasOdometry = true; ///< robotPose is a pose; else it was refused (CarmenOptions::refusesOdometry)

    /// Whether a ray met something: its range is above 0 and less than maxRange.
    bool isReturn(std::size_t ray) const { return ranges[ray] > 0 && ranges[ray] < maxRange; }
    /// Appends the points of the rays with return, in the sensor's frame and in ray order.
    template <typename Scalar>
    void appendPoints(std::vector<Vector2D<Scalar>> &points) const {
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            if (!isReturn(i))
                continue;
            const double angle = startAngle + angleStep * static_cast<double>(i);
            points.emplace_back(Scalar(ranges[i] * std::cos(angle)), Scalar(ranges[i] * std::sin(angle)));
        }
    }
};

/// What the lines PARAM of a log tell of the laser in front. Nothing where they do not.
struct CarmenParameters {
    std::optional<double> maxRange, fieldOfView, resolution; ///< metres, degrees
    std::optional<double> offset, sideOffset, angularOffset; ///< its pose on the robot; metres, radians

    /// Takes one, unless it tells of something else. False when its value is none that it can have.
    bool take(std::string_view name, std::string_view value);
    /// The angle (radians) that so many rays divide into stepsOf() steps: as the parameters tell, or as known
    /// scanners have it; else nothing.
    std::optional<double> angle(std::size_t rays) const;
    /// An even number of rays lacks the last one.
    static std::size_t stepsOf(std::size_t rays) { return rays / 2 * 2; }
};

/// A range that a scanner writes for "no return".
struct RepeatedRange {
    float range = 0;
    double from = 0;      ///< ranges from here on mean it
    std::size_t rays = 0; ///< so many
};

/// The largest range of the scans, when far more rays in many directions have exactly this one than any other
/// of about its size: no wall is as constant. A twentieth of them may be larger.
std::optional<RepeatedRange> findRepeatedRange(const std::vector<CarmenScan> &scans);

/// Which of a log's poses tell the motion that the wheels measured.
enum class CarmenOdometryKind {
    Raw,       ///< ordinary logs: the second triple of a scan is the odometry at the scan
    Corrected, ///< scan poses are a corrected reference; the wheels speak in the ODOM lines between two scans
               ///< only
};

/// What readCarmenLog() does with damaged lines, and what it is told of the scanner.
struct CarmenOptions {
    bool skipDamaged = false; ///< count damaged lines instead of giving an error
    /// Count poses of the odometry that are no finite numbers below 1e7 m, of such a log, instead of giving
    /// an error: a scan is kept without them.
    std::optional<CarmenOdometryKind> refusesOdometry;
    /// Whatever the log says; degrees, metres.
    std::optional<double> fieldOfView, maxRange;
    bool mirrored = false; ///< the angles count clockwise
};

/// A robot's log in CARMEN's text format.
struct CarmenLog {
    std::vector<CarmenScan> scans;
    std::vector<CarmenOdometry> odometry;
    std::size_t damaged = 0;               ///< lines left out, with CarmenOptions::skipDamaged only
    std::optional<InputError> firstDamage; ///< the first of them
    std::size_t odometryRefused = 0;       ///< poses, with CarmenOptions::refusesOdometry only
    CarmenParameters parameters;
    std::optional<RepeatedRange> noReturn; ///< below what the log calls its longest range
    std::size_t assumedRays = 0; ///< of a FLASER whose field of view was taken for 180 degrees; 0: none

    /// Motion of the robot from one scan to a later one as its odometry tells it, composed over the scans
    /// between. Nothing when a part of the way has no odometry.
    std::optional<Transformation2D> odometryMotion(std::size_t from, std::size_t to,
                                                   CarmenOdometryKind kind) const;
    /// Motion between two scans by the laser poses: in a corrected log the reference to compare with.
    Transformation2D referenceMotion(std::size_t from, std::size_t to) const {
        return Transformation2D(scans[from].laserPose).inverse() * Transformation2D(scans[to].laserPose);
    }

    /// The laser on the robot: as the two poses of the scans tell it, the same all over the log and no
    /// farther away than a robot is long; as the parameters, where the two are the same or differ otherwise.
    /// In the origin in a corrected log, both of whose poses are the reference.
    Pose2D sensorOnRobot(CarmenOdometryKind kind) const;

    /// Range from which FLASER readings mean no return: just below the largest of the log when that is one a
    /// scanner writes for it (30 m and more, a little apart by device: 81.91 and 81.83, 51.1
    /// and 51.05, 32.767); else none.
    double guessMaxRange() const;
};

namespace detail {

/// Reads a CARMEN log line by line; see readCarmenLog.
class CarmenReader {
public:
    CarmenReader(std::istream &in, std::string name, CarmenOptions options)
        : lines_(in, std::move(name))
        , options_(options) {}

    Expected<CarmenLog> read();

private:
    using Problem = std::optional<InputError>;
    static constexpr std::size_t maxRays = 100000;
    static constexpr double farthest = 1000;           // metres; no scanner of such logs sees as far
    static constexpr double largestAngle = 2.001 * pi; // a turn, however it was rounded
    static constexpr double widestScan = 2.02 * pi;    // the same of a sum of rounded steps
    static constexpr double widest = 1e7;              // metres; nor does a robot drive as far

    Problem readLine(std::string_view line);
    Problem readParameter();
    Problem readOdometry();
    Problem readFrontLaser();
    Problem readRobotLaser();

    /// The count at field `at` and so many ranges; moves `at` behind them. `rest` fields must follow.
    Problem readRanges(const char *keyword, std::size_t &at, std::size_t rest, CarmenScan &scan);

    Problem finish(CarmenScan &scan, std::size_t poses, std::size_t stamp);

    Problem readPosesOfScan(std::size_t at, CarmenScan &scan);
    /// Nothing where it is counted only.
    Problem refuse(const Problem &problem);

    /// A pose of the wheels between two scans.
    void follow(const Pose2D &pose);
    /// A scan that cannot be read: the odometry restarts at its unknown pose.
    void interrupted();

    Problem readPose(std::size_t at, Pose2D &pose);
    Problem readField(std::size_t at, const char *what, double &value);
    InputError notOfLength(const char *keyword, std::size_t fields, std::size_t ranges = 0) const;
    /// After the last line: angles and longest ranges.
    void describeScanner();
    static void mirror(CarmenScan &scan);

    LineReader lines_;
    CarmenOptions options_;
    CarmenLog log_;
    std::vector<std::string_view> fields_;
    std::optional<Pose2D> base_; ///< where the wheels' motion since the last scan began
    std::optional<Pose2D> last_; ///< the last ODOM since the last scan
    int follows_ = 0;            ///< ODOM lines since the last scan
    Transformation2D moved_;     ///< by the wheels before base_, over damaged scans
};

} // namespace detail

/// The scans and the odometry of a CARMEN log. A line cut short or that goes on behind its message, a field
/// that is no finite number (of a range: no number) or binary data is an error that names `name` and the line
/// (or is counted, with skipDamaged or refusesOdometry); so is a log without a scan.
inline Expected<CarmenLog> readCarmenLog(std::istream &in, std::string name, CarmenOptions options = {}) {
    return detail::CarmenReader(in, std::move(name), options).read();
}

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/CarmenLog.cpp")
