#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/graph/DriveBreaks.h"
#include "vectorlib/graph/LoopCloser.h"
#include "vectorlib/graph/MappedDrive.h"
#include "vectorlib/mapping/MapAligner.h"
#include "vectorlib/mapping/MapBuilder.h"

#include <limits>
#include <vector>

namespace vectorlib {

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
    bool isClear(const MapAlignment &found) const;
    static void move(const DrivePart &part, const Transformation2D &motion, std::vector<Pose2D> &poses);
    void layBeside(const MappedDrive &drive, std::vector<Pose2D> &poses) const;
    static void addTo(Box &box, const MappedDrive &drive, const DrivePart &part,
                      const std::vector<Pose2D> &poses);

    std::vector<DrivePart> parts_;
    MapBuilder joined_; // of the parts that are joined
    MapAligner align_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/DriveParts.cpp")
