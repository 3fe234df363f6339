#include "vectorlib/graph/DriveBreaks.h"

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
            if (found.explained() > mostExplained)
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

} // namespace vectorlib
