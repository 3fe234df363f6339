#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/graph/LoopCloser.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/registration/PointAgreement.h"
#include "vectorlib/registration/PointRefinement.h"

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

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/DriveBreaks.cpp")
