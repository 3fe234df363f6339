#pragma once

#include "vectorlib/graph/LoopCloser.h"
#include "vectorlib/registration/PointRefinement.h"

#include <algorithm>
#include <cstddef>
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
    double mostExplained = 0.4, leastJudged = 0.1, leastContradicted = 0.55;

    /// The key scans with which something new begins; ascending, never the first one.
    std::vector<std::size_t> operator()(const LoopCloser &loops) {
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

private:
    // By key scan: whether a loop leads from one before it to it or to one behind it.
    static std::vector<bool> spanned(const PoseGraph &graph) {
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
    bool doesBreak(const LoopCloser &loops, std::size_t key) {
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
                if (found.explained() > mostExplained)
                    return false;
                ++pairs;
                explained += found.explained();
                contradicted += found.contradictedOfAll();
            }
        const double judged = explained + contradicted;
        return judged > leastJudged * pairs && contradicted > leastContradicted * judged;
    }
    PointAgreement compared(const LoopCloser::Key &before, const LoopCloser::Key &behind,
                            const Transformation2D &motion) {
        before.points.unpack(before_);
        behind.points.unpack(behind_);
        match_.start(before_, behind_);
        Expectation expectation;
        expectation.pose = motion;
        return match_.agreement(match_(motion, expectation));
    }

    PointRefinement match_;
    std::vector<Vector2D<float>> before_, behind_;
};

} // namespace vectorlib
