#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/graph/LoopCloser.h"
#include "vectorlib/graph/MappedDrive.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/mapping/MapAligner.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/registration/PointRefinement.h"
#include "vectorlib/registration/ScanIndex.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace vectorlib {

/// Finds where the way of a drive is not known, as where the robot was carried: the scans after it see
/// through what the scans before it saw, wherever they are laid near each other, and no loop leads from
/// before it to behind it.
class DriveBreaks {
public:
    std::size_t around = 4; ///< key scans before and behind that are compared with each other
    double reach = 4;       ///< those that are nearer; metres
    std::size_t least = 10; ///< key scans between two breaks: fewer are people, or scans that were lost
    /// Share of the points, as of PointAgreement: more of any pair, and the drive goes on; less of all of
    /// them together that can be judged, and there is no evidence; more of these that are contradicted, and
    /// it broke.
    double maxExplained = 0.4, leastJudged = 0.1, leastContradicted = 0.55;

    /// The key scans with which something new begins; ascending, never the first one.
    std::vector<std::size_t> operator()(const LoopCloser &loops);

private:
    // By key scan: whether a loop leads from one before it to it or to one behind it.
    static std::vector<bool> spanned(const PoseGraph &graph);
    bool doesBreak(const LoopCloser &loops, std::size_t key);
    PointAgreement compared(const LoopCloser::Key &before, const LoopCloser::Key &behind,
                            const Transformation2D &motion);

    PointRefinement match_;
    std::vector<Vector2D<float>> before_, behind_;
};

/// A stretch of a drive whose way is known.
struct DrivePart {
    std::size_t begin = 0, end = 0; ///< numbers of its scans
    bool isJoined = true;           ///< known where it lies to the longest one
};

/// Where the way of a drive is not known in between, its parts are maps of their own: each is laid where the
/// walls of the others show it, as by MapAligner. One that shows no place of the others is laid beside them.
class DriveParts {
public:
    DriveBreaks find;
    double leastOverlap = 5;        ///< of the walls that two parts share; metres
    double leastReliability = 0.02; ///< of their directions
    double gap = 5;                 ///< to one that is laid beside; metres

    /// Moves the poses (of all scans, as the loops are closed) of the parts that there are; in order of time,
    /// one where the drive never broke. The first pose stays.
    std::vector<DrivePart> operator()(const MappedDrive &drive, std::vector<Pose2D> &poses);

private:
    struct Box {
        double left = std::numeric_limits<double>::infinity(), right = -left, bottom = left;

        void add(Vector2D<double> p);
    };

    void divide(const LoopCloser &loops, std::size_t scans);
    // False where none of the rest shows a place of those that are joined.
    bool joinSome(const MappedDrive &drive, std::vector<Pose2D> &poses);
    bool isClear(const MapAlignment &found) const {
        return found.outcome == MapAlignment::Outcome::Found && found.overlap.length >= leastOverlap &&
               found.overlap.reliability >= leastReliability;
    }
    static void move(const DrivePart &part, const Transformation2D &motion, std::vector<Pose2D> &poses) {
        for (std::size_t i = part.begin; i < part.end; ++i)
            poses[i] = (motion * Transformation2D(poses[i])).pose();
    }
    void layBeside(const MappedDrive &drive, std::vector<Pose2D> &poses) const;
    static void addTo(Box &box, const MappedDrive &drive, const DrivePart &part,
                      const std::vector<Pose2D> &poses);

    std::vector<DrivePart> parts_;
    MapBuilder joined_; // of the parts that are joined
    MapAligner align_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/DriveParts.cpp")
