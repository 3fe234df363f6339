#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CorrespondenceTracker.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/edges/EdgeExtractor.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/ScanPairMatcher.h"
#include "vectorlib/mapping/VectorMap.h"

#include <chrono>
#include <vector>

namespace vectorlib {

/// What happened to one scan, and how long each step took; milliseconds.
struct ScanReport {
    enum class Outcome {
        Matched, ///< the pose was found in the map (the first scan defines the map's frame)
        Lost,    ///< no acceptable match: the expected pose stands
        Skipped  ///< too few edges to say anything: the expected pose stands, the map is left alone
    };
    Outcome outcome = Outcome::Skipped;
    Pose2D pose; ///< of the sensor in the map's frame
    double segmentMs = 0, vectorizeMs = 0, matchMs = 0, mapMs = 0;
    double totalMs() const { return segmentMs + vectorizeMs + matchMs + mapMs; }
};

/// Settings of MapBuilder.
struct MapBuilderSettings {
    bool grow = true;         ///< false: only find the pose, leave the map as it is
    std::size_t minEdges = 2; ///< scans with fewer edges are skipped
    double mergeDistance =
        0.10; ///< a matched edge is merged when no farther from its map edge; metres, root mean square
    double newEdgeLength = 0.15; ///< shorter unmatched edges do not enter the map; metres
    int lostBeforeRestart = 3;   ///< after so many lost scans in a row the map goes on from the expected pose
    /// Match each scan with the one before it first, for a better expectation: worth its time where scans lie
    /// far apart.
    bool matchPrevious = false;
    /// How far a pose that such a match expects may be wrong: standard deviations; metres, radians.
    double previousDeviationXY = 0.01, previousDeviationAlpha = 0.005;
    TrackingSettings tracking; ///< from a pose that such a match expects
    /// Edges of the map that fewer scans have seen take no part: they may be things that move.
    std::int64_t leastObservations = 0;
};

/// Builds a vector map scan by scan: extract edges, predict, match, merge. Reads as the pipeline of thesis
/// figure 3.1.
class MapBuilder {
public:
    MapBuilderSettings settings;
    EdgeExtractor extract;
    CorrespondenceTracker track;
    ScanPairMatcher matchPair; ///< of the scan before with this one
    VectorMap map;
    /// Edges that another scanner saw at the moment of the next scan, in the frame of that scan's sensor:
    /// they are matched and mapped with its own.
    std::vector<EdgeRaw2D> beside;

    /// Takes a scan (sensor frame, in the order of ScanOrder) and where the sensor is expected to be (map
    /// frame), by odometry or by its motion so far.
    const ScanReport &process(PointSpan<float> scan, const Pose2D &expected) {
        find(scan, expected);
        return conclude(scan, true);
    }
    /// The first half of it, which may be done again for the same scan, straightened otherwise or expected
    /// elsewhere: the pose. Leaves the map alone.
    const ScanReport &find(PointSpan<float> given, const Pose2D &expected);
    /// The other half: the map takes the scan as it was found last. One that is not sure is left out, and the
    /// next one is not matched with it.
    const ScanReport &conclude(PointSpan<float> scan, bool sure);
    /// Between the two: the match does not count, the scan is lost; its pose stays.
    void refuse() {
        if (report_.outcome == ScanReport::Outcome::Matched)
            report_.outcome = ScanReport::Outcome::Lost;
    }

    /// Between the two: the scan lies elsewhere after all, by this motion of the map.
    void move(const Transformation2D &moved) {
        expected_ = moved * expected_;
        pose_ = moved * pose_;
        match_.pose = pose_;
        report_.pose = pose_.pose();
    }

    /// The map takes edges (sensor frame) that were seen from a pose that is known otherwise; it stays as it
    /// is told, and so does what is known of the last scan but for match() and its candidates.
    void place(const std::vector<EdgeRaw2D> &edges, const Pose2D &pose);

    /// False where the last scan could not be matched with the one before.
    bool isFollowed() const { return followed_; }
    /// Whether the last scan was matched with one before, which then tells expected().
    bool isExpectedByScan() const { return byScan_; }
    /// Whether neither the map nor the scan before shows the last scan, as when it saw the ground: the next
    /// one is matched with that before it again.
    bool isPassedOver() const { return passedOver_ > 0; }
    /// Whether the map goes on where the last scan was expected, as so many before it were lost, too.
    bool isRestart() const {
        return settings.grow && report_.outcome == ScanReport::Outcome::Lost &&
               lost_ == settings.lostBeforeRestart;
    }
    /// Whether walls that bend left the way about their centre open for the last scan.
    bool isBent() const { return isBent_; }
    const ScanReport &report() const { return report_; }
    /// The match of the last scan; pairs refer to candidates() and edges().
    const Match &match() const { return match_; }
    /// Where the last scan was expected: by its match with the scan before, else as it was told.
    const Transformation2D &expected() const { return expected_; }
    /// Map edges that the last scan was compared with, by index of the match's static set.
    const std::vector<int> &candidates() const { return numbers_; }
    /// Their segments.
    const std::vector<LineSegment2D<double>> &known() const { return static_; }
    /// The edges of the last scan, sensor frame.
    const std::vector<EdgeRaw2D> &edges() const { return *edges_; }
    /// How many of them, the first ones, its own sensor saw; the others were beside.
    std::size_t own() const { return own_; }

    /// The sensor was put elsewhere: the next scan is matched with the map alone.
    void forgetPrevious() {
        previousPoints_.clear();
        passedOver_ = 0;
    }
    /// The same, and the scans that were lost until now do not count.
    void placed() {
        forgetPrevious();
        lost_ = 0;
    }
    /// Takes a map that was made anew and gives the old one; `moved` tells where in it a pose of the old one
    /// lies.
    void correct(VectorMap &other, const Transformation2D &moved);
    void clear();

private:
    using Clock = std::chrono::steady_clock;
    static double milliseconds(Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double, std::milli>(to - from).count();
    }

    // The expected pose by the motion since the scan before, found in the scans; else the given one. Tells
    // the tracker how good it is.
    Transformation2D expectedByPrevious(PointSpan<float> scan, const Pose2D &given);
    void remember(PointSpan<float> scan);
    // Not where the next scan would be looked for anywhere, nor too many in a row.
    bool passesOver() const {
        return !followed_ && report_.outcome != ScanReport::Outcome::Matched &&
               !matchPair.settings.searchAnywhere && passedOver_ + 1 < settings.lostBeforeRestart;
    }
    void locate(const Transformation2D &expected);
    // Between walls that bend the map tells no more than the scan before.
    void leaveOpen();
    // The part of the map that the scan can touch from any permitted pose.
    void collectVisible(const Transformation2D &expected);
    void updateMap();
    bool mergeable(const LineSegment2D<double> &known, const LineSegment2D<double> &seen) const {
        return known.meanSquareAcross(seen) <= settings.mergeDistance * settings.mergeDistance;
    }

    const std::vector<EdgeRaw2D> *edges_ = nullptr;
    std::vector<EdgeRaw2D> joint_; // own edges and those beside
    std::size_t own_ = 0;
    std::vector<LineSegment2D<double>> static_;
    std::vector<int> numbers_;
    std::vector<int> partner_;
    Transformation2D pose_, expected_;
    std::vector<Vector2D<float>> previousPoints_;
    std::vector<EdgeRaw2D> previousEdges_;
    Transformation2D previousPose_;
    bool byScan_ = false; // expected
    bool isBent_ = false;
    int passedOver_ = 0; // scans since then
    Match match_;
    ScanReport report_;
    int lost_ = 0;
    bool concluded_ = true;
    bool followed_ = true;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/MapBuilder.cpp")
