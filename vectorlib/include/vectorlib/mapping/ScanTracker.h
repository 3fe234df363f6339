#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CorrespondenceTracker.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/CounterEvidence.h"
#include "vectorlib/mapping/DriveBreak.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/PlaceKnowledge.h"
#include "vectorlib/mapping/PoseTrust.h"
#include "vectorlib/mapping/ScanLocator.h"
#include "vectorlib/mapping/ScanPairMatcher.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/motion/MotionModel.h"
#include "vectorlib/motion/Odometry.h"
#include "vectorlib/motion/OpenDirection.h"
#include "vectorlib/motion/ScannerCheck.h"
#include "vectorlib/places/PlaceFitter.h"
#include "vectorlib/places/PlaceSearch.h"
#include "vectorlib/places/Relocalized.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace vectorlib {

/// Settings of ScanTracker.
struct ScanTrackerSettings {
    bool compensateMotion = true; ///< straighten scans that were taken while the sensor moved
    bool useOdometry = true;      ///< where a scan has any; else the motion is expected to go on as before
    Pose2D sensorOnRobot;         ///< pose of the sensor in the frame of the robot, whose odometry it is
    Pose2D secondOnRobot;         ///< the same of the second scanner, where there is one
    TrackingSettings tracking;    ///< where the pose is well expected
    /// A pose is well expected by odometry, or when the last scan is not longer ago than this; seconds.
    double moment = 0.5;
    /// How much of the last scans may speak against a pose in a finished map; see ScanTracker::against.
    double maxAgainst = 0.35;
    /// The place is sought where a growing map contradicts it, see DriveBreak; else the map goes on there
    /// after lost scans.
    bool seekWhereContradicted = true;
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
    /// Pieces of the way that contradict the odometry, as the one before did: wheels turn on the spot, or the
    /// poses are wrong.
    std::uint64_t contradicted = 0;
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

    ScanTracker() {
        withoutPeople_.shortest = withoutPeopleAndBeyond_.shortest = 0.5;
        withoutPeopleAndBeyond_.beyond = 5;
        apply(ScanTrackerSettings());
    }

    /// Takes new settings; map and pose stay.
    void apply(const ScanTrackerSettings &settings);

    /// Compensates the motion during the scan, expects, matches, maps. The scan's points become those of one
    /// moment, the middle of its time, and its stamp this moment, to which the pose refers.
    const ScanReport &process(TimedScan &scan);

    /// Whether the map grows while the place in it is known.
    void grow(bool grows) {
        grows_ = grows;
        builder.settings.grow = maps();
    }
    /// Puts the sensor somewhere, standing still: the place is known. `against`: what is known to speak
    /// against it.
    void place(const Pose2D &pose, double against = 0);
    /// The same for a place that somebody tells: nothing is mapped there until five scans in a row agree, and
    /// walls told it in all directions.
    void claim(const Pose2D &pose);
    /// Puts the sensor where a search found it; in a map that grows that is to be confirmed.
    void placeFound(const Pose2D &pose, double against = 0);
    /// The place may be wrong: nothing is mapped until five scans in a row agree with it.
    void doubt() {
        place_.doubt(grows_ && !builder.map.isEmpty());
        isAfterPause_ = false;
    }
    /// The place in the map is not known: scans count as lost until it is found or told.
    void seek();
    /// What is known of the place in the map. Nothing is mapped but where it is Known.
    PlaceState placeState() const { return place_.state(); }
    /// Whether scans are drawn now: the map grows, and scans and odometry tell the same along open walls.
    bool draws() const { return maps() && !(settings_.seekWhereContradicted && open_.isDisputed()); }
    /// Finds the last scan in the whole map; puts the sensor there when it was found and `apply`.
    Relocalized relocalize(bool apply);
    /// Whether a search of the whole map would help: enough scans in a row were lost, the place is sought, or
    /// was found and is to be confirmed some way on.
    bool wantsSearch() const;
    /// Whether that search is to confirm a place that was found before.
    bool wantsToConfirm() const;
    /// Searches, whatever the time: relocalizes, or confirms.
    Relocalized search();
    /// The same by itself, to be called after each scan: when a search is wanted, and for at most about a
    /// tenth of the time; else nothing.
    std::optional<Relocalized> recover();
    /// The map was made anew: takes it, and gives the old one. `moved` tells where in it a pose of the old
    /// one lies; tracking goes on from there.
    void correct(VectorMap &map, const Transformation2D &moved);
    /// Forgets map, pose and counts.
    void clear();

    /// What tells how the last scan lies to the one before.
    TrackedBy trackedBy() const;
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
        return features ? poseTrust(*features) * belief() * (grows_ && !place_.isKnown() ? claimed : 1) : 0;
    }
    /// What speaks against the pose in a finished map, as of CounterEvidence; 0 while the map grows.
    double against() const { return maps() ? 0 : evidence_.value(); }
    /// Whether little does.
    bool agrees() const { return against() < 0.5 * settings_.maxAgainst; }
    /// Whether that is too much for the pose to be right: the scan then counts as lost.
    bool isContradicted() const { return against() > settings_.maxAgainst; }
    /// What it goes by; nothing where it is 0 anyway.
    std::optional<PoseTrust::Features> trustFeatures() const;
    /// The frame of the odometry in that of the map, by the last scan that had any.
    std::optional<Transformation2D> odometryFrame() const { return locate_.odometryFrame(); }
    /// The way by the scans that were matched and by the odometry, while the two contradict each other.
    const std::optional<OdometryCheck::Ways> &contradiction() const { return check_.contradiction(); }
    /// What the drive tells of the scanner.
    const ScannerCheck &scanner() const { return scanner_; }
    /// What is known of the second scanner.
    const SecondScanner &second() const { return locate_.second; }
    /// Whether the last scan is straight; else it is in doubt and stays out of the map.
    bool isStraight() const { return located_.isStraight; }
    const MotionModel &motion() const { return locate_.motion(); }
    const ScanTrackerCounts &counts() const { return counts_; }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr double claimed = 0.5; // trust of a place that is not known yet, for that of one that is
    static constexpr double openReliability = OpenDirection::openReliability;
    static constexpr double coveredReliability = 0.7; // of a pose that the odometry tells there
    static constexpr double fewMatched = 0.6; // of the seen length: then the odometry tells nothing more
    // Two scans so close together must show about the same: less than this share of the points is suspicious.
    static constexpr double near_m = 0.4, near_rad = 0.35, fewExplained = 0.8;
    static constexpr std::uint64_t eachNth = 5;                        // scan of a growing map is judged
    static constexpr double surprising_m = 0.25, surprising_rad = 0.2; // from where it was guessed
    static constexpr double minMapped = 0.85; // of the seen length: the map shows the scan
    static constexpr double fewKnown = 0.6;   // of the points, where no odometry tells the pose

    // Whether the map grows: a scan may be drawn, and is judged for that.
    bool maps() const { return grows_ && place_.isKnown(); }
    bool isMatched() const { return builder.report().outcome == ScanReport::Outcome::Matched; }
    void setUp(TimedScan &scan);
    // The motion since a pose, where the odometry and the scan before tell it, each on its own.
    void checkScanner(const Transformation2D &before, const std::optional<double> &lastStamp, double stamp);
    // A scan of the second scanner that contradicts is left out, and the pose found again without it.
    void checkSecond(const TimedScan &scan);
    // How the points of a scan lie in the map, or those of the second scanner, each seen from its place.
    PlaceFit fitOf(const TimedScan &scan, bool bySecond, const PlaceFitter &by);
    // A scan that too much speaks against, or whose place is sought, is lost.
    void judge(const TimedScan &scan, const std::optional<double> &lastStamp);
    // In a growing map: a scan that the one before does not show, where the two were taken close together.
    void judgeBreak(const TimedScan &scan);
    void breakOff();
    // In a finished map: what speaks against the pose that was found.
    void weigh(const TimedScan &scan, const std::optional<double> &lastStamp);
    // In a finished map: along a direction that the lines leave open the ends of walls tell the place.
    void slide(const TimedScan &scan);
    void checkOdometry(const TimedScan &scan);
    void followOpen(const TimedScan &scan);
    double belief() const {
        return std::min(open_.belief(), std::clamp(2 - 2 * against() / settings_.maxAgainst, 0.0, 1.0));
    }
    bool isByScan() const {
        return located_.isWellExpected && (builder.isExpectedByScan() || builder.isPassedOver());
    }
    void count(const ScanReport &report);

    ScanTrackerSettings settings_;
    ScanLocator locate_;
    LocatedScan located_; // the last scan
    OdometryCheck check_;
    ScannerCheck scanner_;
    std::uint64_t epoch_ = 0; // of the odometry that is checked
    ScanTrackerCounts counts_;
    PlaceSearch search_;
    std::vector<Vector2D<float>> points_;                            // of the last scan, at one moment
    bool isPlaced_ = false, wasPlaced_ = false, wasMatched_ = false; // since the last scan, and before it
    int lostInARow_ = 0;
    PlaceKnowledge place_;
    bool grows_ = true;
    DriveBreak break_;
    bool isInterrupted_ = false; // the drive, by a pause or a leap, and no scan was matched since
    bool isAfterPause_ = false;  // the place is doubted as the drive was interrupted, and for nothing else
    bool isUnguided_ = false;    // the odometry may be wrong since then, and no scan has agreed with the map
    PlaceFitter withoutPeople_;  // they are drawn, too: short walls do not speak against a pose
    PlaceFitter withoutPeopleAndBeyond_; // for the second scanner: what lies before walls speaks, too
    OpenDirection open_;
    std::optional<Vector2D<double>> slid_; // where the last scan lies better, as yet alone; metres, map frame
    CounterEvidence evidence_;
    Clock::time_point nextSearch_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/ScanTracker.cpp")
