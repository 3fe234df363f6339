#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <cstddef>
#include <vector>

namespace vectorlib {

/// How a match by relations ended.
enum class RelationOutcome {
    Matched,          ///< the pose is found
    BadSettings,      ///< a setting is negative, 0 where it must not be, too large or not a number
    TooFewReference,  ///< fewer than two usable segments in the reference scan
    TooFewCurrent,    ///< fewer than two usable segments in the current scan
    NoCommonRelation, ///< no relation of the current scan is found in the reference scan
    OnePair,          ///< only one pair of segments matches
    OneDirection,     ///< the matching segments are too nearly parallel to fix the place
    Contradiction,    ///< the matching segments agree on a rotation, but on no place
    Unspecific,       ///< too little matches to tell the place from others like it
    Ambiguous         ///< another place fits nearly as well
};

/// The outcome in words, for people.
const char *describe(RelationOutcome outcome);

/// The match of a current scan with a reference scan. Numbers in pairs are those of the segments as given.
struct RelationMatch {
    RelationOutcome outcome = RelationOutcome::NoCommonRelation;
    /// Moves the current scan onto the reference. Identity unless Matched or Ambiguous.
    Transformation2D pose;
    /// The same by common edges alone, as published (Algorithms 8 and 9), from all pairs of the table.
    Transformation2D byEdges;
    std::vector<CorrespondencePair> byScores; ///< all pairs that Algorithm 5 found, best first
    std::vector<CorrespondencePair> pairs; ///< all that lie on each other at the pose, whatever their scores
    double score = 0;                      ///< largest merged score
    double reliability = 0;                ///< in [0, 1], of the pairs' directions
    double ambiguity = 0;                  ///< mean of a pair, weighted by length; m^2
    double deviation = 0;                  ///< standard deviation of the position; metres
    double matchedLength = 0;              ///< of the shorter segments of the pairs; metres
    double evidence = 0;      ///< matched length less what stands where the other scan looked through; metres
    double rivalEvidence = 0; ///< the same of the best place elsewhere; metres
    std::size_t leftOut = 0;  ///< segments that are not finite, have no length, or are beyond the bound
    std::size_t virtualLeftOut = 0; ///< virtual edges beyond the bound
    bool isCut = false;             ///< a bound left out relations
    std::size_t scores = 0;         ///< entries of the matching table
    std::size_t compared = 0;       ///< comparisons of two relations: the work done

    bool isMatched() const { return outcome == RelationOutcome::Matched; }
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/RelationMatch.cpp")
