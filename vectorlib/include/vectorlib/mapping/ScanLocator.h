#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CorrespondenceTracker.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/SecondScanner.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/motion/MotionModel.h"
#include "vectorlib/motion/Odometry.h"
#include "vectorlib/motion/OpenDirection.h"

#include <optional>
#include <vector>

namespace vectorlib {

/// Where a scan was expected, and how it was found from there.
struct LocatedScan {
    Transformation2D expected;    ///< pose in the map, by the odometry or by the motion so far
    Transformation2D way;         ///< to it from the pose of the scan before
    bool isOdometryKnown = false; ///< the odometry tells that pose
    bool byOdometry = false;      ///< the scan was found from there, and not by the motion so far
    bool isWellExpected = false;  ///< by the odometry, or soon after the scan before
    bool hasPaused = false;       ///< not soon after it: meanwhile anything may have happened
    bool hasLeapt = false;        ///< expected farther away than a robot drives
    bool isDisputed = false;      ///< the scans tell another way along open walls: the odometry counts
    bool isStraight = true;       ///< else the scan is in doubt, and stays bent

    bool isInterrupted() const { return hasPaused || hasLeapt; }
};

/// Finds scans in a map from where they are expected, and straightens them on the way. Where the odometry
/// loses a scan, or bends it or leaps and its points have times, the scan is sought where the motion so far
/// leads, too, and the better place counts.
class ScanLocator {
public:
    bool compensateMotion = true; ///< straighten scans that were taken while the sensor moved
    TrackingSettings tracking;    ///< where the pose is well expected
    /// A pose is well expected by odometry, or when the last scan is not longer ago than this; seconds.
    double moment = 0.5;
    SecondScanner second; ///< its edges are taken beside those of a scan while it is believed

    /// The scan's points become those of one moment, the middle of its time, and its stamp this moment.
    LocatedScan operator()(MapBuilder &builder, TimedScan &scan, OpenDirection &open);
    /// The scan was taken at that pose after all.
    void update(const Pose2D &pose, const TimedScan &scan);
    /// The sensor was put somewhere, standing still.
    void place(const Pose2D &pose);
    /// The map was made anew: what was in it lies elsewhere.
    void move(const Transformation2D &moved) {
        motion_.move(moved);
        odometry_.move(moved);
        second.move(moved);
    }
    /// The sensor's pose in the frame of the robot.
    void setMount(const Pose2D &sensor) { odometry_.setMount(sensor); }

    const MotionModel &motion() const { return motion_; }
    /// The frame of the odometry in that of the map, by the last scan that had any.
    std::optional<Transformation2D> odometryFrame() const { return odometry_.frame(); }
    /// Of the scan before, unless the sensor was put elsewhere since; seconds.
    const std::optional<double> &lastStamp() const { return lastStamp_; }

private:
    static constexpr double followed_s = 0.2;  // since the scan before: a guess by the motion so far is good
    static constexpr double straight_m = 0.01; // a scan bent by no more is straight
    static constexpr int maxTries = 3;
    static constexpr std::int64_t knownForLong = 10; // scans
    static constexpr double pauses = 3;              // of the usual time between two scans: it has paused
    static constexpr double fastest_mps = 5, fastest_radps = 6; // that a robot moves
    static constexpr double close_m = 0.2, close_rad = 0.2;     // between two scans
    static constexpr double odometryErrs = 2, leastErr_m = 0.01,
                            errsByWay = 0.15; // deviations; metres, share
    static constexpr double leap_m = 0.1, leap_rad = 0.1;
    static constexpr double muchBetter = 1.02; // a score, where the odometry tells otherwise
    static constexpr double muchMore = 1.1;    // walls that are known for long

    // Where the sensor is thought to be, how it moves, and how sure that is.
    struct Guess {
        Pose2D pose;
        Twist2D twist;
        bool well = false; // expected
        bool byOdometry = false;
        std::optional<OdometryModel::Deviations> deviations;
    };
    // How a scan was found by a guess.
    struct Found {
        bool straight = true, again = false; // it had to be straightened again
        double score = -1;                   // matched length less what lies apart, metres; below 0: lost
    };

    // Straightens the scan by the velocity that is guessed, and again by what its points say of it then.
    Found find(MapBuilder &builder, TimedScan &scan, const Guess &guess);
    // The same by the odometry, and by walls that are known for long.
    Found findByOdometry(MapBuilder &builder, TimedScan &scan, const Guess &guess);
    // A scan was found farther from where the odometry puts it than this errs: what tells its pose may move
    // by itself. Goes by the odometry and by walls known for long where these leave that direction open, and
    // where more of them are found so; false: the scan is found as it was.
    bool goesByOdometry(MapBuilder &builder, TimedScan &scan, const Guess &guess, LocatedScan &located,
                        OpenDirection &open, Found &found);
    // The walls of the map that the scan was matched with, and that are known for long.
    static WallDirections knownWalls(const MapBuilder &builder);
    TwistCorrection::Result twistError(const MapBuilder &builder, const TimedScan &scan);
    void tellHowSure(MapBuilder &builder, const Guess &guess) const;
    // Searches at least as widely as it is set up.
    static TrackingSettings poorly(const TrackingSettings &well);
    // The two guesses differ by more than the speed of a robot changes between two scans.
    static bool leaps(const Guess &a, const Guess &b, double seconds);
    // Brings the second scanner's scan to the moment of the scan; where no odometry tells it, by this
    // velocity.
    void takeBeside(MapBuilder &builder, const TimedScan &scan, const Twist2D &twist);
    bool isStraightened(const TimedScan &scan) const { return compensateMotion && !scan.seconds.empty(); }
    bool isLastWithin(double seconds, double stamp) const {
        return lastStamp_ && stamp > *lastStamp_ && stamp - *lastStamp_ <= seconds;
    }

    double period_ = 0;                // of the scans; seconds
    std::vector<Vector2D<float>> raw_; // the points as they were measured
    float middle_ = 0;                 // of their times
    std::vector<LineSegment2D<double>> known_;
    TwistCorrection correct_;
    MotionModel motion_;
    OdometryModel odometry_;
    std::optional<double> lastStamp_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/ScanLocator.cpp")
