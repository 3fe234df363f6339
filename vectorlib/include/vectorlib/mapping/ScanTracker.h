#pragma once

#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/Relocalization.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/motion/MotionCompensation.h"
#include "vectorlib/motion/MotionModel.h"
#include "vectorlib/motion/OdometryModel.h"

#include <functional>

namespace vectorlib {

struct ScanTrackerSettings {
    bool compensateMotion = true;
    bool useOdometry = true;   ///< where a scan has any; else the motion is expected to go on as before
    Pose2D sensorOnRobot;      ///< the odometry is that of the robot
    TrackingSettings tracking; ///< where the pose is well expected
    /// A pose is well expected by odometry, or when the last scan is not longer ago than this; seconds.
    double moment = 0.5;
    std::int64_t relocalizeAfter = 10; ///< lost scans in a row; 0: never by itself
    double relocalizeSeconds = 3;      ///< longest search
};

/// Counts of all scans since the start or the last clear, and the time of each step; milliseconds.
struct ScanTrackerCounts {
    std::uint64_t scans = 0, matched = 0, lost = 0, skipped = 0;
    std::uint64_t byOdometry = 0; ///< scans whose expected pose came from the odometry
    double segmentMs = 0, vectorizeMs = 0, matchMs = 0, mapMs = 0;
    double totalMs() const { return segmentMs + vectorizeMs + matchMs + mapMs; }
};

/// Follows a sensor through its map and lets the map grow, scan by scan: the same for a robot that drives and
/// for a log. Time is that of the scans; only recover() goes by a clock.
class ScanTracker {
public:
    MapBuilder builder;
    /// What segmentation settings become that follow from a scan's scanner; nothing: they stay.
    std::function<EarSettings(const EarSettings &)> segmentation;

    ScanTracker() { apply(ScanTrackerSettings()); }

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
        const float middle = middleTime(scan.seconds);
        if (settings_.compensateMotion)
            compensateMotion(scan.points, scan.seconds, middle,
                             scan.odometry ? odometry_.twist(*scan.odometry, scan.begin(), scan.end())
                                           : motion_.twist());
        scan.stamp += double(middle);
        EarSettings scanner = EarSettings::forScanner(scan.fieldOfView, scan.rays);
        scanner.closed = scan.closed;
        builder.extract.segment.settings = segmentation ? segmentation(scanner) : scanner;
        const ScanReport &report = builder.process(scan.points, expect(scan));
        motion_.update(report.pose, scan.stamp);
        if (scan.odometry)
            odometry_.update(report.pose, *scan.odometry, scan.stamp);
        lastStamp_ = scan.stamp;
        count(report);
        return report;
    }

    /// Puts the sensor somewhere, standing still.
    void place(const Pose2D &pose) {
        motion_.reset(pose);
        odometry_.reset();
        builder.forgetPrevious();
        lastStamp_.reset();
    }
    /// Finds the last scan in the whole map; puts the sensor there when it was found and `apply`.
    Relocalized relocalize(bool apply) {
        if (counts_.scans == 0)
            return {};
        const Relocalized &result = search_(builder.map, builder.edges(), builder.report().pose);
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
    /// Forgets map, pose and counts.
    void clear() {
        builder.clear();
        lostInARow_ = 0;
        place({});
        counts_ = ScanTrackerCounts();
    }

    const MotionModel &motion() const { return motion_; }
    const ScanTrackerCounts &counts() const { return counts_; }

private:
    using Clock = std::chrono::steady_clock;

    // Where the sensor is expected; tells the builder how sure that is.
    Pose2D expect(const TimedScan &scan) {
        const auto expected = scan.odometry ? odometry_.expect(*scan.odometry, scan.stamp) : std::nullopt;
        const bool well = expected || !lastStamp_ || isMomentAgo(*lastStamp_, scan.stamp);
        TrackingSettings &track = builder.track.settings;
        track = well ? settings_.tracking : poorly(settings_.tracking);
        ScanPairSettings &pair = builder.matchPair.settings;
        pair = well ? ScanPairSettings() : ScanPairSettings::forPoorExpectation();
        if (!expected)
            return motion_.predict(scan.stamp);
        ++counts_.byOdometry;
        if (expected->deviations) {
            track.expectedDeviationXY = expected->deviations->xy;
            track.expectedDeviationAlpha = expected->deviations->alpha;
            pair.deviationXY = std::min(pair.deviationXY, expected->deviations->xy);
            pair.deviationAlpha = std::min(pair.deviationAlpha, expected->deviations->alpha);
        }
        return expected->pose;
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
    MotionModel motion_;
    OdometryModel odometry_;
    ScanTrackerCounts counts_;
    Relocalization search_;
    std::optional<double> lastStamp_; // of the scan before, unless the sensor was put elsewhere since
    int lostInARow_ = 0;
    Clock::time_point nextSearch_;
};

} // namespace vectorlib
