#pragma once

#include "vectorlib/correspondence/PotentialPairs.h"
#include "vectorlib/observation/Discrepancy.h"
#include "vectorlib/registration/LineSegmentRegistration.h"

#include <cstdint>

namespace vectorlib {

/// Defaults: the published experiments (thesis appendices).
struct SearchSettings {
    PermittedError permitted;
    double reliability = 0.10; ///< least of a solution; also what tells directions apart
    double ambiguity = 0.0025; ///< most energy of a pair; m^2
    Stiffness stiffness;
    double discrepancy = 0.2; ///< most of an accepted solution; m^2
    /// Or this share of the area that both views see: outlines that are seen a ray sooner or later differ by
    /// areas that grow with the place.
    double discrepancyShare = 0.03;
    double sharedView = 0.25;   ///< least share of the seen angle that the expected view must show
    double matchedShare = 0.30; ///< least share of the dynamic length that must have partners
    std::size_t maxSolutions = 16;
    std::size_t maxPairs = 5000;           ///< potential pairs
    std::size_t maxCompared = 50000000;    ///< pairs of segments that are near each other, half a second
    std::uint64_t maxCombinations = 20000; ///< bundles tried

    bool isGood() const {
        for (double value :
             {permitted.dx, permitted.dy, permitted.dalpha, reliability, ambiguity, stiffness.alpha,
              stiffness.xy, discrepancy, discrepancyShare, sharedView, matchedShare})
            if (!(value >= 0) || !std::isfinite(value))
                return false;
        return maxSolutions > 0 && maxPairs > 0 && maxCompared > 0 && maxCombinations > 0;
    }
    /// Whether an expected view shows enough of what was seen under `observedAngle` to tell anything.
    bool isEvidence(const ViewComparison &view, double observedAngle) const {
        return view.angle > 0 && view.angle >= sharedView * observedAngle;
    }
};

} // namespace vectorlib
