#include "vectorlib/graph/DriveParts.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY std::vector<std::size_t> DriveBreaks::operator()(const LoopCloser &loops) {
    const std::size_t keys = loops.keys().size();
    const std::vector<bool> isSpanned = spanned(loops.graph());
    std::vector<std::size_t> breaks;
    std::size_t begin = 0; // of the part
    for (std::size_t k = least; k + least <= keys; ++k)
        if (!isSpanned[k] && k - begin >= least && doesBreak(loops, k)) {
            breaks.push_back(k);
            begin = k;
        }
    return breaks;
}

VECTORLIB_BODY std::vector<bool> DriveBreaks::spanned(const PoseGraph &graph) {
    std::vector<int> changes(graph.poses.size() + 1, 0);
    for (const PoseConstraint &c : graph.constraints)
        if (c.mayBeWrong && !c.isRefused()) {
            ++changes[std::min(c.from, c.to) + 1];
            --changes[std::max(c.from, c.to) + 1];
        }
    std::vector<bool> result(graph.poses.size());
    int open = 0;
    for (std::size_t k = 0; k < result.size(); ++k)
        result[k] = (open += changes[k]) > 0;
    return result;
}

VECTORLIB_BODY bool DriveBreaks::doesBreak(const LoopCloser &loops, std::size_t key) {
    const std::vector<Pose2D> &poses = loops.graph().poses;
    const std::size_t end = std::min(poses.size(), key + 1 + around);
    double pairs = 0, explained = 0, contradicted = 0;
    for (std::size_t before = key; before-- > key - std::min(key, around);)
        for (std::size_t behind = key; behind < end; ++behind) {
            const Transformation2D motion =
                Transformation2D(poses[before]).inverse() * Transformation2D(poses[behind]);
            const bool isNext = before + 1 == behind; // the way between may come from just these two
            if (motion.translation().norm() > reach || isNext)
                continue;
            const PointAgreement found = compared(loops.keys()[before], loops.keys()[behind], motion);
            if (found.explained() > maxExplained)
                return false;
            ++pairs;
            explained += found.explained();
            contradicted += found.contradictedOfAll();
        }
    const double judged = explained + contradicted;
    return judged > leastJudged * pairs && contradicted > leastContradicted * judged;
}

VECTORLIB_BODY PointAgreement DriveBreaks::compared(const LoopCloser::Key &before,
                                                    const LoopCloser::Key &behind,
                                                    const Transformation2D &motion) {
    before.points.unpack(before_);
    behind.points.unpack(behind_);
    match_.start(before_, behind_);
    Expectation expectation;
    expectation.pose = motion;
    return match_.agreement(match_(motion, expectation));
}

VECTORLIB_BODY std::vector<DrivePart> DriveParts::operator()(const MappedDrive &drive,
                                                             std::vector<Pose2D> &poses) {
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

VECTORLIB_BODY void DriveParts::Box::add(Vector2D<double> p) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    bottom = std::min(bottom, p.y);
}

VECTORLIB_BODY void DriveParts::divide(const LoopCloser &loops, std::size_t scans) {
    parts_.assign(1, {});
    for (const std::size_t key : find(loops)) {
        parts_.back().end = loops.scanOf(key);
        parts_.push_back({loops.scanOf(key), 0, true});
    }
    parts_.back().end = scans;
}

VECTORLIB_BODY bool DriveParts::joinSome(const MappedDrive &drive, std::vector<Pose2D> &poses) {
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

VECTORLIB_BODY void DriveParts::layBeside(const MappedDrive &drive, std::vector<Pose2D> &poses) const {
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

VECTORLIB_BODY void DriveParts::addTo(Box &box, const MappedDrive &drive, const DrivePart &part,
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

} // namespace vectorlib
