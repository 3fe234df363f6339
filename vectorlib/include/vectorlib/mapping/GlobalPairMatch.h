#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/registration/SurfaceAgreement.h"

#include <vector>

namespace vectorlib {

/// A motion that may be the one between two scans.
struct GlobalPairSolution {
    Transformation2D pose;      ///< of the second scan's sensor in the frame of the first
    SurfaceAgreement agreement; ///< of both scans
    double score = 0;           ///< that of the agreement; solutions are ranked by it
    double probability = 0;     ///< that the motion is within 10 cm and 2 degrees; see MatchProbability
};

/// What is known of the motion between two scans.
enum class GlobalPairVerdict {
    Found,         ///< the first solution is to be trusted
    Ambiguous,     ///< several motions fit alike: look at all solutions
    OpenDirection, ///< the scans slide on each other, as along a corridor: solutions stand all along it
    TooUnlike,     ///< no motion explains enough
    NothingFixed,  ///< the first scan shows too few surfaces
    NothingMoving  ///< the second scan shows too few surfaces
};

/// The verdict in words, for people.
const char *describe(GlobalPairVerdict verdict);

/// The motion between two scans of which nothing else is known.
struct GlobalPairMatch {
    std::vector<GlobalPairSolution> solutions; ///< distinct ones, best first
    GlobalPairVerdict verdict = GlobalPairVerdict::TooUnlike;
    /// By how much the score falls when the best solution slides half a metre where it is held least.
    double slideLoss = 0;
    bool searchedWidely = false; ///< the first, quick search did not convince

    bool isAccepted() const { return verdict == GlobalPairVerdict::Found; }
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/GlobalPairMatch.cpp")
