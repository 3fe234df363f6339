#pragma once

#include "vectorlib/graph/DriveBreaks.h"
#include "vectorlib/graph/MappedDrive.h"
#include "vectorlib/mapping/MapAligner.h"

#include <algorithm>
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
    std::vector<DrivePart> operator()(const MappedDrive &drive, std::vector<Pose2D> &poses) {
        divide(drive.loops, poses.size());
        if (parts_.size() == 1)
            return parts_;
        const Pose2D first = poses.front();
        const auto longest =
            std::max_element(parts_.begin(), parts_.end(), [](const DrivePart &a, const DrivePart &b) {
                return a.end - a.begin < b.end - b.begin;
            });
        for (DrivePart &part : parts_)
            part.isJoined = &part == &*longest;
        joined_.clear();
        drive.extend(joined_, poses, longest->begin, longest->end);
        while (joinSome(drive, poses))
            ;
        layBeside(drive, poses);
        const Transformation2D back = Transformation2D(first) * Transformation2D(poses.front()).inverse();
        for (Pose2D &pose : poses)
            pose = (back * Transformation2D(pose)).pose();
        return parts_;
    }

private:
    struct Box {
        double left = std::numeric_limits<double>::infinity(), right = -left, bottom = left;

        void add(Vector2D<double> p) {
            left = std::min(left, p.x);
            right = std::max(right, p.x);
            bottom = std::min(bottom, p.y);
        }
    };

    void divide(const LoopCloser &loops, std::size_t scans) {
        parts_.assign(1, {});
        for (const std::size_t key : find(loops)) {
            parts_.back().end = loops.scanOf(key);
            parts_.push_back({loops.scanOf(key), 0, true});
        }
        parts_.back().end = scans;
    }
    // False where none of the rest shows a place of those that are joined.
    bool joinSome(const MappedDrive &drive, std::vector<Pose2D> &poses) {
        bool joins = false;
        for (DrivePart &part : parts_) {
            if (part.isJoined)
                continue;
            MapBuilder own;
            drive.extend(own, poses, part.begin, part.end);
            std::vector<MapEdge> walls;
            own.map.forEach([&](const MapEdge &edge) { walls.push_back(edge); });
            MapAlignment found = align_(joined_.map, walls);
            if (!isClear(found))
                found = align_.confirm(joined_.map, walls, {}); // crowds of people contradict each other, too
            if (!isClear(found))
                continue;
            joins = part.isJoined = true;
            move(part, found.overlap.motion, poses);
            drive.extend(joined_, poses, part.begin, part.end);
        }
        return joins;
    }
    bool isClear(const MapAlignment &found) const {
        return found.outcome == MapAlignment::Outcome::Found && found.overlap.length >= leastOverlap &&
               found.overlap.reliability >= leastReliability;
    }
    static void move(const DrivePart &part, const Transformation2D &motion, std::vector<Pose2D> &poses) {
        for (std::size_t i = part.begin; i < part.end; ++i)
            poses[i] = (motion * Transformation2D(poses[i])).pose();
    }
    void layBeside(const MappedDrive &drive, std::vector<Pose2D> &poses) const {
        Box all;
        for (const DrivePart &part : parts_)
            if (part.isJoined)
                addTo(all, drive, part, poses);
        for (const DrivePart &part : parts_) {
            if (part.isJoined)
                continue;
            Box own;
            addTo(own, drive, part, poses);
            move(part, {all.right + gap - own.left, all.bottom - own.bottom, 0}, poses);
            all.right += gap + own.right - own.left;
        }
    }
    static void addTo(Box &box, const MappedDrive &drive, const DrivePart &part,
                      const std::vector<Pose2D> &poses) {
        for (std::size_t i = part.begin; i < part.end; ++i) {
            const Transformation2D pose(poses[i]);
            box.add(pose.translation());
            for (const EdgeRaw2D &edge : drive.edges()[i]) {
                box.add(pose * edge.segment.begin());
                box.add(pose * edge.segment.end());
            }
        }
    }

    std::vector<DrivePart> parts_;
    MapBuilder joined_; // of the parts that are joined
    MapAligner align_;
};

} // namespace vectorlib
