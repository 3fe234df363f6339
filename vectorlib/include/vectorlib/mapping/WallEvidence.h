#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/ScanDrive.h"

#include <array>
#include <vector>

namespace vectorlib {

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

    static int directionOf(Vector2D<double> p);
    static Vector2D<double> towards(int direction);

    void divide(const std::vector<LineSegment2D<double>> &walls);
    bool isSamePlace(const Pose2D &a, const Pose2D &b) const;
    // How far the scan saw in each direction; 0 where it has no edge.
    void look(const std::vector<EdgeRaw2D> &edges);
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
