#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/ParallelTwins.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/mapping/WallEvidence.h"
#include "vectorlib/tls/TlsSums.h"

#include <vector>

namespace vectorlib {

/// Settings of MapReview: which walls are one, and which were seen through so often that they leave.
struct MapReviewSettings {
    int known = 0;              ///< walls with smaller numbers were there before the drive: they stay
    double mergeWithin = 0.15;  ///< walls side by side that no two scans saw both of become one; metres
    double mostlyThrough = 4;   ///< a part leaves that was seen through so many times as often as it was seen
    int fewestThrough = 4;      ///< and so many times more
    int fewestLater = 8;        ///< or that was seen through so often since it was seen last
    double unlikely = 1e-3;     ///< if that is so improbable by how often it was missed before
    double shortestGone = 0.35; ///< shorter parts of a wall stay; metres
    double shortestLeft = 0.15; ///< shorter pieces between parts that leave, leave with them; metres
    double widestGap = 0.5;     ///< walls on one line join over a gap that nothing was seen through; metres
    double cornerReach = 0.10;  ///< ends nearer to where two lines meet move there; metres
    double leastCornerSine = 0.5; ///< of the angle between these lines
};

/// What a review changed.
struct MapReviewCounts {
    std::size_t merged = 0;  ///< walls that were another one seen again
    std::size_t joined = 0;  ///< walls that go on as another one
    std::size_t removed = 0; ///< walls that later scans contradict
    std::size_t cut = 0;     ///< walls that lost a part
    double contradicted = 0; ///< length of what left for that; metres
    std::size_t corners = 0; ///< ends that were moved to a corner
};

/// Reviews a finished map by all scans of the drive that made it: walls that are there twice become one, what
/// scans saw through leaves, pieces of one wall join, corners close. Poses stay, and lines too, but for those
/// that take in others. Needs only the edges of the scans, no points; on a copy of the map it may run beside
/// the drive.
class MapReview {
public:
    MapReviewSettings settings;

    /// Changes the map as the scans of the drive tell, and counts what it changed. The poses of the drive are
    /// in the map's frame.
    MapReviewCounts operator()(VectorMap &map, const ScanDrive &drive);

private:
    static std::vector<int> numbersOf(const VectorMap &map);

    bool isKnown(int number) const { return number < settings.known; }
    void mergeTwins(VectorMap &map, const ScanDrive &drive);

    // What scans say of the walls, and of the gaps between walls on one line.
    void gather(VectorMap &map, const ScanDrive &drive);
    // To the nearest wall that goes on behind this one's end.
    void findGap(VectorMap &map, int number);

    // Whether a wall that is seen as often as before would hardly be missed so often.
    bool isContradicted(double seen, double before, double after) const;
    bool isContradicted(const PartEvidence &e) const {
        return isContradicted(e.seen, e.throughBefore, e.throughAfter);
    }
    // The parts of a wall that scans contradict leave, or the whole.
    void leave(VectorMap &map, std::size_t index);
    // Intervals along the wall that stay.
    void findLeft(std::size_t index, std::size_t count, double part);
    // The longest interval keeps the id.
    void divide(VectorMap &map, const MapEdge &wall);
    // The sums of a piece, as if the points were spread evenly along the wall.
    static TlsSums shareOf(const MapEdge &wall, const LineSegment2D<double> &piece);

    void joinOverGaps(VectorMap &map);
    bool isSeenThrough(std::size_t index) const;

    // Free space is on the left: around a corner one wall ends where the next begins.
    void closeCorners(VectorMap &map, int number);

    struct Gap {
        int before = -1, behind = -1;
        LineSegment2D<double> segment;
    };
    MapReviewCounts counts_;
    ParallelTwins twins_;
    WallEvidence evidence_;
    std::vector<int> walls_; // their numbers
    std::vector<Gap> gaps_;
    std::vector<LineSegment2D<double>> pieces_; // the walls, then the gaps
    std::vector<bool> cutAtBegin_, cutAtEnd_;
    std::vector<std::pair<double, double>> left_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/MapReview.cpp")
