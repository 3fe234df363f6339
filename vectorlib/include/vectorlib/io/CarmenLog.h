#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/io/CarmenScan.h"
#include "vectorlib/io/InputError.h"
#include "vectorlib/io/TextInput.h"

#include <optional>
#include <string>
#include <vector>

namespace vectorlib {

/// Which of a log's poses tell the motion that the wheels measured.
enum class CarmenOdometryKind {
    Raw,       ///< ordinary logs: the second triple of a scan is the odometry at the scan
    Corrected, ///< scan poses are a corrected reference; the wheels speak in the ODOM lines between two scans
               ///< only
};

/// What readCarmenLog() does with damaged lines.
struct CarmenOptions {
    bool skipDamaged = false; ///< count damaged lines instead of giving an error
    /// Count poses of the odometry that are no finite numbers below 1e7 m, of such a log, instead of giving
    /// an error: a scan is kept without them.
    std::optional<CarmenOdometryKind> refusesOdometry;
};

/// A robot's log in CARMEN's text format.
struct CarmenLog {
    std::vector<CarmenScan> scans;
    std::vector<CarmenOdometry> odometry;
    std::size_t damaged = 0;               ///< lines left out, with CarmenOptions::skipDamaged only
    std::optional<InputError> firstDamage; ///< the first of them
    std::size_t odometryRefused = 0;       ///< poses, with CarmenOptions::refusesOdometry only

    /// Motion of the robot from one scan to a later one as its odometry tells it, composed over the scans
    /// between. Nothing when a part of the way has no odometry.
    std::optional<Transformation2D> odometryMotion(std::size_t from, std::size_t to,
                                                   CarmenOdometryKind kind) const;
    /// Motion between two scans by the laser poses: in a corrected log the reference to compare with.
    Transformation2D referenceMotion(std::size_t from, std::size_t to) const {
        return Transformation2D(scans[from].laserPose).inverse() * Transformation2D(scans[to].laserPose);
    }

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
    static constexpr double widest = 1e7;              // metres; nor does a robot drive as far

    Problem readLine(std::string_view line);

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
    InputError tooShort(const char *keyword, std::size_t fields) const;

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

/// The scans and the odometry of a CARMEN log. A line cut short, a field that is no finite number or binary
/// data is an error that names `name` and the line (or is counted, with skipDamaged or refusesOdometry); so
/// is a log without a scan.
inline Expected<CarmenLog> readCarmenLog(std::istream &in, std::string name, CarmenOptions options = {}) {
    return detail::CarmenReader(in, std::move(name), options).read();
}

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/CarmenLog.cpp")
