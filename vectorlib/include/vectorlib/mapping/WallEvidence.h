#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/observation/Observer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace vectorlib {

/// Which wall of a map an edge lies on. Looks at the map as it was indexed last.
class WallFinder {
public:
    double maxAngle = 0.17;    ///< between the two; radians
    double maxDistance = 0.15; ///< of the edge from the wall's line, root mean square; metres

    /// Takes the walls of a map as they are now.
    void index(const VectorMap &map);
    /// The id of the nearest wall beside at least half of the edge (map frame) that faces the same way; -1
    /// where there is none.
    std::int64_t operator()(const LineSegment2D<double> &edge);

private:
    struct Wall {
        std::int64_t id;
        LineSegment2D<double> segment;
    };
    std::vector<Wall> walls_;
    SegmentGrid grid_{0.5};
};

/// Lets the walls of a map that was made anew keep the ids that they had: a wall is the same when most of the
/// length that scans saw of it is what they saw of the old one, and the other way round.
class WallIds {
public:
    /// The old map; `drive` at the poses by which it was made.
    void remember(const VectorMap &map, const ScanDrive &drive) {
        next_ = static_cast<std::int64_t>(map.slots().size());
        find(map, drive, old_);
    }
    /// The new map, of the same scans in the same order. Walls that are not the same as an old one get ids
    /// that no wall had.
    void keep(VectorMap &map, const ScanDrive &drive);

private:
    // What scans saw of both, by new and old wall; metres.
    using Lengths = std::map<std::pair<std::int64_t, std::int64_t>, double>;

    // The wall of every edge of the drive, one scan after the other.
    void find(const VectorMap &map, const ScanDrive &drive, std::vector<std::int64_t> &walls);
    // New wall and old one where each shares most with the other.
    static std::map<std::int64_t, std::int64_t> bestOf(const Lengths &shared);

    WallFinder finder_;
    std::vector<std::int64_t> old_, new_;
    std::int64_t next_ = 0;
};

/// How many scans saw a part of a wall, and how many saw through it.
struct PartEvidence {
    int seen = 0;
    int throughBefore = 0; ///< of those before it was seen last
    int throughAfter = 0;  ///< of those since it was seen last

    int through() const { return throughBefore + throughAfter; }
};

/// Settings of WallEvidence: when a part of a wall was seen, and when a scan saw through it.
struct WallEvidenceSettings {
    double part = 0.2;          ///< walls are looked at in parts of about this length; metres
    double seenWithin = 0.15;   ///< a part is seen where the scan's edge is no farther from its line; metres
    double throughBehind = 0.2; ///< and seen through where the edge lies at least so far behind it; metres
    double reach = 10;          ///< parts farther from the sensor are left out; metres
    double leastSine = 0.25;    ///< and parts seen under a smaller angle; sine
    /// A scan counts only when the sensor moved so far since the last one that did; metres, radians.
    double newPlace = 0.05, newHeading = 0.1;
};

/// Asks the scans of a drive for segments of a map: what each scan's expected view (thesis 7.4.2) of a wall
/// is, beside what it saw in that direction. Only edges speak: directions in which a scan has none tell
/// nothing.
class WallEvidence {
public:
    WallEvidenceSettings settings;

    /// Of segments in the frame of the drive's poses.
    void operator()(const std::vector<LineSegment2D<double>> &walls, const ScanDrive &drive);
    /// Number of parts of a segment, all of one length.
    std::size_t parts(std::size_t wall) const { return starts_[wall + 1] - starts_[wall]; }
    /// What the scans tell of a part of a segment; parts are numbered from its begin.
    const PartEvidence &part(std::size_t wall, std::size_t number) const {
        return evidence_[starts_[wall] + number];
    }

private:
    static constexpr int directions = 720; // about half a degree each

    static int directionOf(Vector2D<double> p) {
        return std::clamp(static_cast<int>((turnOf(p) + 2) * (directions / 4)), 0, directions - 1);
    }
    static Vector2D<double> towards(int direction) {
        const double turn = (direction + 0.5) * (4.0 / directions) - 2, up = std::abs(turn), x = 1 - up;
        const double y = up <= 1 ? up : 2 - up;
        return {x, turn < 0 ? -y : y};
    }

    void divide(const std::vector<LineSegment2D<double>> &walls);
    bool isSamePlace(const Pose2D &a, const Pose2D &b) const {
        return std::hypot(a.x - b.x, a.y - b.y) < settings.newPlace &&
               std::abs(wrapAngle(a.theta - b.theta)) < settings.newHeading;
    }
    // How far the scan saw in each direction by its first edges; 0 where it has no edge. What another scanner
    // saw beside them tells nothing of the sight from this one.
    void look(const std::vector<EdgeRaw2D> &edges, std::size_t count);
    void ask(const std::vector<LineSegment2D<double>> &walls, const Transformation2D &pose);
    // A part at a place, of a wall whose front lies `across` towards the sensor.
    void judge(Vector2D<double> at, double across, PartEvidence &evidence) const;

    SegmentGrid grid_;
    std::vector<std::size_t> starts_{0}; // of each segment's parts
    std::vector<PartEvidence> evidence_;
    std::array<float, directions> range_{};
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/WallEvidence.cpp")
