#pragma once

#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/PoseTrust.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/mapping/TrackedBy.h"
#include "vectorlib/motion/MotionCompensation.h"
#include "vectorlib/motion/MotionModel.h"
#include "vectorlib/motion/OdometryModel.h"
#include "vectorlib/motion/TwistCorrection.h"
#include "vectorlib/places/PlaceSearch.h"

#include <functional>

namespace vectorlib {

/// Settings of ScanTracker.
struct ScanTrackerSettings {
    bool compensateMotion = true; ///< straighten scans that were taken while the sensor moved
    bool useOdometry = true;      ///< where a scan has any; else the motion is expected to go on as before
    Pose2D sensorOnRobot;         ///< pose of the sensor in the frame of the robot, whose odometry it is
    TrackingSettings tracking;    ///< where the pose is well expected
    /// A pose is well expected by odometry, or when the last scan is not longer ago than this; seconds.
    double moment = 0.5;
    std::int64_t relocalizeAfter = 10; ///< lost scans in a row; 0: never by itself
    double relocalizeSeconds = 3;      ///< longest search
};

/// Counts of all scans since the start or the last clear, and the time of each step; milliseconds.
struct ScanTrackerCounts {
    std::uint64_t scans = 0, matched = 0, lost = 0, skipped = 0; ///< all, and those of each outcome
    /// Scans found in the map though the one before shows something else, and times that the map went on
    /// where the scan was expected, as it was lost for too long: the sensor may have been carried elsewhere
    /// there.
    std::uint64_t doubted = 0, restarts = 0;
    std::uint64_t byOdometry = 0; ///< scans whose expected pose came from the odometry
    double segmentMs = 0, vectorizeMs = 0, matchMs = 0, mapMs = 0;
    double totalMs() const { return segmentMs + vectorizeMs + matchMs + mapMs; }
};

/// Follows a sensor through its map and lets the map grow, scan by scan: the same for a robot that drives and
/// for a log. Time is that of the scans; only recover() goes by a clock. A scan that was not taken at once
/// enters the map only when it is found to be straight there.
class ScanTracker {
public:
    MapBuilder builder;
    PoseTrust poseTrust;
    /// What segmentation settings become that follow from a scan's scanner; nothing: they stay.
    std::function<EarSettings(const EarSettings &)> segmentation;

    ScanTracker() { apply(ScanTrackerSettings()); }

    /// Takes new settings; map and pose stay.
    void apply(const ScanTrackerSettings &settings) {
        settings_ = settings;
        builder.settings.matchPrevious = true;
        builder.settings.tracking = settings.tracking;
        odometry_.setMount(settings.sensorOnRobot);
        search_.maxSeconds = settings.relocalizeSeconds;
    }

    /// Compensates the motion during the scan, expects, matches, maps. The scan's points become those of one
    /// moment, the middle of its time, and its stamp this moment, to which the pose refers.
    const ScanReport &process(TimedScan &scan) {
        if (!settings_.useOdometry)
            scan.odometry.reset();
        const double begin = scan.begin(), end = scan.end();
        middle_ = middleTime(scan.seconds);
        scan.stamp += double(middle_);
        raw_ = scan.points;
        wasPlaced_ = std::exchange(isPlaced_, false);
        wasMatched_ = builder.report().outcome == ScanReport::Outcome::Matched;
        EarSettings scanner = EarSettings::forScanner(scan.fieldOfView, scan.rays);
        scanner.closed = scan.closed;
        builder.extract.segment.settings = segmentation ? segmentation(scanner) : scanner;
        straight_ = locate(scan, begin, end);
        const ScanReport &report = builder.conclude(scan.points, straight_);
        points_ = scan.points;
        motion_.update(report.pose, scan.stamp);
        if (scan.odometry)
            odometry_.update(report.pose, *scan.odometry, scan.stamp);
        lastStamp_ = scan.stamp;
        count(report);
        return report;
    }

    /// Puts the sensor somewhere, standing still.
    void place(const Pose2D &pose) {
        isPlaced_ = true;
        motion_.reset(pose);
        odometry_.reset();
        builder.forgetPrevious();
        lastStamp_.reset();
    }
    /// Finds the last scan in the whole map; puts the sensor there when it was found and `apply`.
    Relocalized relocalize(bool apply) {
        if (counts_.scans == 0)
            return {};
        const Relocalized &result = search_(builder.map.slots(), builder.edges(), points_);
        if (apply && result.isFound())
            place(result.places.front().pose);
        return result;
    }
    /// The same by itself, to be called after each scan: when enough scans in a row were lost, and for at
    /// most about a tenth of the time; else nothing.
    std::optional<Relocalized> recover() {
        if (!isSearchDue())
            return std::nullopt;
        const Relocalized result = relocalize(true);
        const std::chrono::duration<double, std::milli> pause(std::max(1000.0, 10 * result.ms));
        nextSearch_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(pause);
        return result;
    }
    /// The map was made anew: takes it, and gives the old one. `moved` tells where in it a pose of the old
    /// one lies; tracking goes on from there.
    void correct(VectorMap &map, const Transformation2D &moved) {
        builder.correct(map, moved);
        search_.index().clear();
        motion_.move(moved);
        odometry_.move(moved);
    }
    /// Forgets map, pose and counts.
    void clear() {
        builder.clear();
        search_.index().clear();
        lostInARow_ = 0;
        place({});
        counts_ = ScanTrackerCounts();
    }

    /// What tells how the last scan lies to the one before.
    TrackedBy trackedBy() const {
        if (wasPlaced_)
            return TrackedBy::Placed;
        const bool isMatched = builder.report().outcome == ScanReport::Outcome::Matched;
        return isMatched && wasMatched_ && isWellExpected_ ? TrackedBy::Map
               : isByScan()                                ? TrackedBy::Scan
               : byOdometry_                               ? TrackedBy::Odometry
                                                           : TrackedBy::Nothing;
    }
    /// The motion from the pose of the scan before to the last scan, as this tells it: one that the map shows
    /// again leaps by what went wrong since it did so last.
    Transformation2D tracked(const Transformation2D &before) const {
        const bool isLeap = trackedBy() == TrackedBy::Scan;
        return before.inverse() * (isLeap ? builder.expected() : Transformation2D(builder.report().pose));
    }
    /// How probable it is that the pose of the last scan is right, as of PoseTrust; 0 of a scan that was lost
    /// or skipped, or that the map had nothing to compare with.
    double trust() const {
        const auto features = trustFeatures();
        return features ? poseTrust(*features) : 0;
    }
    /// What it goes by; nothing where it is 0 anyway.
    std::optional<PoseTrust::Features> trustFeatures() const {
        const Match &m = builder.match();
        if (builder.report().outcome != ScanReport::Outcome::Matched || !(m.visibleLength > 0))
            return std::nullopt;
        return PoseTrust::features(m, builder.expected(), builder.track.settings.finalDistance);
    }
    /// The frame of the odometry in that of the map, by the last scan that had any.
    std::optional<Transformation2D> odometryFrame() const { return odometry_.frame(); }
    /// Whether the last scan is straight; else it is in doubt and stays out of the map.
    bool isStraight() const { return straight_; }
    const MotionModel &motion() const { return motion_; }
    const ScanTrackerCounts &counts() const { return counts_; }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr double followed_s = 0.2;  // since the scan before: a guess by the motion so far is good
    static constexpr double straight_m = 0.01; // a scan bent by no more is straight
    static constexpr int mostTries = 3;
    static constexpr double leap_m = 0.1, leap_rad = 0.1;
    static constexpr double muchBetter = 1.02; // a score, where the odometry tells otherwise

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

    // False when the scan is in doubt: it stays bent. Where the odometry loses it, or bends it or leaps and
    // its points have times, the scan is sought where the motion so far leads, too, and the better place
    // counts.
    bool locate(TimedScan &scan, double begin, double end) {
        const Guess byMotion{motion_.predict(scan.stamp),
                             motion_.twist(),
                             !lastStamp_ || isMomentAgo(*lastStamp_, scan.stamp),
                             false,
                             {}};
        Guess guess = byMotion;
        if (scan.odometry) {
            guess.twist = odometry_.twist(*scan.odometry, begin, end);
            if (const auto expected = odometry_.expect(*scan.odometry, scan.stamp))
                guess = {expected->pose, guess.twist, true, true, expected->deviations};
        }
        byOdometry_ = false;
        isWellExpected_ = lastStamp_ && scan.stamp > *lastStamp_ && scan.stamp - *lastStamp_ <= followed_s;
        Found found = find(scan, guess);
        const bool doubtful = found.again || leaps(byMotion, guess, end - begin);
        if (scan.odometry && (found.score < 0 || (isStraightened(scan) && doubtful))) {
            const Found other = find(scan, byMotion);
            const bool better = other.score > muchBetter * found.score || (other.straight && !found.straight);
            if (other.score > 0 && better)
                return other.straight;
            found = find(scan, guess);
        }
        byOdometry_ = guess.byOdometry;
        isWellExpected_ = isWellExpected_ || guess.byOdometry;
        counts_.byOdometry += byOdometry_;
        return found.straight;
    }
    // Straightens the scan by the velocity that is guessed, and again by what its points say of it then.
    Found find(TimedScan &scan, const Guess &guess) {
        tellHowSure(guess);
        Found found;
        Twist2D twist = guess.twist;
        for (int tries = 1;; ++tries) {
            if (isStraightened(scan)) {
                scan.points = raw_;
                compensateMotion(scan.points, scan.seconds, middle_, twist);
            }
            const ScanReport &report = builder.find(scan.points, guess.pose);
            if (report.outcome != ScanReport::Outcome::Matched)
                return {tries == 1, tries > 1, report.outcome == ScanReport::Outcome::Lost ? -1.0 : 0.0};
            if (!isStraightened(scan))
                break;
            const TwistCorrection::Result wrong = twistError(scan);
            found.straight = wrong.bend <= straight_m;
            found.again = tries > 1 || !found.straight;
            if (found.straight || tries == mostTries)
                break;
            twist = {twist.vx + wrong.twist.vx, twist.vy + wrong.twist.vy, twist.omega + wrong.twist.omega};
        }
        const double apart = builder.match().rms / builder.track.settings.finalDistance;
        found.score = builder.match().matchedLength * (1 - apart * apart);
        return found;
    }
    bool isStraightened(const TimedScan &scan) const {
        return settings_.compensateMotion && !scan.seconds.empty();
    }
    TwistCorrection::Result twistError(const TimedScan &scan) {
        const Transformation2D toSensor = Transformation2D(builder.report().pose).inverse();
        known_.clear();
        for (const LineSegment2D<double> &edge : builder.known()) {
            const LineSegment2D<double> seen = toSensor * edge;
            if (seen.across({0, 0}) > 0) // its front
                known_.push_back(seen);
        }
        return correct_(scan.points, scan.seconds, middle_, known_);
    }
    // The two guesses differ by more than the speed of a robot changes between two scans.
    static bool leaps(const Guess &a, const Guess &b, double seconds) {
        const auto isFar = [](const Pose2D &from, const Pose2D &to) {
            const Pose2D way = from.inverse() * to;
            return std::hypot(way.x, way.y) > leap_m || std::abs(way.theta) > leap_rad;
        };
        return isFar(a.pose, b.pose) || isFar(a.twist.motion(seconds), b.twist.motion(seconds));
    }
    void tellHowSure(const Guess &guess) {
        TrackingSettings &track = builder.track.settings;
        track = guess.well ? settings_.tracking : poorly(settings_.tracking);
        ScanPairSettings &pair = builder.matchPair.settings;
        pair = guess.well ? ScanPairSettings() : ScanPairSettings::forPoorExpectation();
        if (!guess.deviations)
            return;
        track.expectedDeviationXY = guess.deviations->xy;
        track.expectedDeviationAlpha = guess.deviations->alpha;
        pair.deviationXY = std::min(pair.deviationXY, guess.deviations->xy);
        pair.deviationAlpha = std::min(pair.deviationAlpha, guess.deviations->alpha);
    }
    // Searches at least as widely as it is set up.
    static TrackingSettings poorly(const TrackingSettings &well) {
        TrackingSettings s = well;
        const TrackingSettings poor = TrackingSettings::forPoorExpectation();
        s.permitted = {std::max(s.permitted.dx, poor.permitted.dx),
                       std::max(s.permitted.dy, poor.permitted.dy),
                       std::max(s.permitted.dalpha, poor.permitted.dalpha)};
        s.expectedDeviationXY = std::max(s.expectedDeviationXY, poor.expectedDeviationXY);
        s.expectedDeviationAlpha = std::max(s.expectedDeviationAlpha, poor.expectedDeviationAlpha);
        s.minMatchedShare = std::max(s.minMatchedShare, poor.minMatchedShare);
        return s;
    }
    bool isByScan() const {
        return isWellExpected_ && (builder.isExpectedByScan() || builder.isPassedOver());
    }
    bool isMomentAgo(double before, double stamp) const {
        return stamp > before && stamp - before <= settings_.moment;
    }
    bool isSearchDue() const {
        // A growing map goes on from the expected pose after some lost scans: from then on it holds the scan
        // itself, at a place that may be wrong, and the search would find that.
        const bool holdsTheScan = builder.settings.grow && lostInARow_ >= builder.settings.lostBeforeRestart;
        return settings_.relocalizeAfter > 0 && lostInARow_ >= settings_.relocalizeAfter && !holdsTheScan &&
               Clock::now() >= nextSearch_;
    }
    void count(const ScanReport &report) {
        counts_.doubted += report.outcome == ScanReport::Outcome::Matched && !builder.isFollowed();
        counts_.restarts += builder.isRestart();
        lostInARow_ = report.outcome == ScanReport::Outcome::Lost ? lostInARow_ + 1 : 0;
        ++counts_.scans;
        switch (report.outcome) {
        case ScanReport::Outcome::Matched:
            ++counts_.matched;
            break;
        case ScanReport::Outcome::Lost:
            ++counts_.lost;
            break;
        case ScanReport::Outcome::Skipped:
            ++counts_.skipped;
            break;
        }
        counts_.segmentMs += report.segmentMs;
        counts_.vectorizeMs += report.vectorizeMs;
        counts_.matchMs += report.matchMs;
        counts_.mapMs += report.mapMs;
    }

    ScanTrackerSettings settings_;
    std::vector<Vector2D<float>> raw_; // the points as they were measured
    float middle_ = 0;                 // of their times
    std::vector<LineSegment2D<double>> known_;
    MotionModel motion_;
    OdometryModel odometry_;
    ScanTrackerCounts counts_;
    PlaceSearch search_;
    std::vector<Vector2D<float>> points_; // of the last scan, at one moment
    TwistCorrection correct_;
    std::optional<double> lastStamp_; // of the scan before, unless the sensor was put elsewhere since
    bool byOdometry_ = false, straight_ = true, isWellExpected_ = false; // the last scan
    bool isPlaced_ = false, wasPlaced_ = false, wasMatched_ = false;     // since the last scan, and before it
    int lostInARow_ = 0;
    Clock::time_point nextSearch_;
};

} // namespace vectorlib
