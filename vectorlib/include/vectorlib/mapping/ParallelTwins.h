#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/mapping/WallEvidence.h"

#include <cstdint>
#include <map>
#include <vector>

namespace vectorlib {

/// Two walls of a map side by side that face the same way.
struct TwinWalls {
    int first = 0, second = 0; ///< their numbers; the first was seen at least as often
    double distance = 0; ///< of the second in front of the first, in the middle of what they share; metres
    double from = 0, to = 0; ///< what they share, along the first; metres
    int witnesses = 0;       ///< scans that saw both at once, so far apart
};

/// Which walls ParallelTwins compares.
struct ParallelTwinsSettings {
    std::int64_t minObservations = 3; ///< walls that were seen less often are left out
    double maxAngle = pi / 18;        ///< between the two; radians
    double least = 0.05, most = 0.6;  ///< distance between the two; metres
    int enoughWitnesses = 2;          ///< with so many both are real: a door in its frame, a cupboard, glass
};

/// How much of a map is there twice; metres, of walls seen at least as often as was asked for.
struct TwinShare {
    double walls = 0; ///< length of all
    double twins = 0; ///< length of the parts beside a twin that is not real
    double real = 0;  ///< length of the parts beside a twin that is real
    double share() const { return walls > 0 ? twins / walls : 0; }
};

/// Finds walls that a map may hold twice: parallel, facing the same way, side by side over at least half of
/// the shorter one. Scans tell which of them are real: those that saw both at once.
class ParallelTwins {
public:
    ParallelTwinsSettings settings;

    /// All such pairs, the nearest first. Valid until the next call.
    const std::vector<TwinWalls> &operator()(const VectorMap &map, const ScanDrive &drive);
    /// How much of the map is there twice: the lengths of all such pairs.
    TwinShare share(const VectorMap &map, const ScanDrive &drive);
    /// Of a pair of the last call.
    bool isReal(const TwinWalls &pair) const { return pair.witnesses >= settings.enoughWitnesses; }

private:
    // Intervals along walls, by the numbers of the walls.
    using PartsOfWalls = std::map<int, std::vector<std::pair<double, double>>>;

    // What two intervals of one wall share counts once.
    static double lengthOf(PartsOfWalls &walls);
    void pairWith(const VectorMap &map, int number);
    void addIfTwins(const VectorMap &map, int first, int second);
    void countWitnesses(const VectorMap &map, const ScanDrive &drive);
    // A scan is a witness when what it saw of both walls is at least half as far apart as they are.
    void askScan(const VectorMap &map, const std::vector<EdgeRaw2D> &edges, const Transformation2D &pose);

    // The longest edge of a scan on a wall, and how far it lies in front of the wall.
    struct Sight {
        double length = 0, off = 0;
    };
    WallFinder find_;
    SegmentGrid grid_{1.0};
    std::vector<TwinWalls> pairs_;
    std::map<int, std::vector<std::size_t>> pairsOf_; // by the number of the first wall
    std::map<int, Sight> seen_;                       // by the number of the wall
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/ParallelTwins.cpp")
