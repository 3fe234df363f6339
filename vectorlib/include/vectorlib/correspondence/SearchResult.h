#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/observation/Discrepancy.h"

#include <cstdint>
#include <vector>

namespace vectorlib {

/// Why a solution is not accepted; the first of its faults in this order.
enum class Fault {
    None,         ///< the solution is accepted
    Reliability,  ///< the directions of its pairs are too much alike to fix the place
    Ambiguity,    ///< its pairs contradict each other
    MatchedShare, ///< too little of the dynamic set has partners
    NoEvidence,   ///< too little of the static set would be seen from there
    Discrepancy,  ///< what would be seen from there differs from what was seen
    NotPermitted  ///< its transformation is not in the permitted set
};

/// The fault in words, for people.
const char *describe(Fault fault);

/// A set of correspondences, its transformation and what speaks for it.
struct Solution {
    Transformation2D pose; ///< moves the dynamic set onto the static one
    std::vector<CorrespondencePair> pairs;
    double reliability = 0;  ///< in [0, 1], of the pairs' directions
    double ambiguity = 0;    ///< mean energy (7.44) of a pair, weighted by length; m^2
    double matchedShare = 0; ///< of the length of the dynamic set that has partners, in [0, 1]
    ViewComparison view;     ///< of the expected view and the dynamic set
    double score = 0;        ///< in [0, 1]; solutions are ranked by it
    bool accepted = false;
    Fault fault = Fault::None; ///< None exactly when accepted
};

/// How a search ended.
enum class SearchOutcome {
    Complete,     ///< every combination was considered
    Cut,          ///< a bound ended the search: there may be better solutions
    BadSettings,  ///< a setting or the expected transformation is not finite, negative or 0 where it must not
    NothingFixed, ///< no usable segment of the static set is within reach
    NothingMoving,   ///< no usable segment in the dynamic set
    NoPotentialPair, ///< no permitted transformation brings any two segments together
    TooManyPairs,    ///< more pairs near each other than the bounds of the settings
    OneDirection,    ///< all potential pairs are parallel: the shift along them is not known
    NoCombination    ///< no two directions agree on a transformation
};

/// The outcome in words, for people.
const char *describe(SearchOutcome outcome);

/// The solutions of a search, and the work that it took.
struct SearchResult {
    std::vector<Solution> solutions; ///< accepted ones first, then by score
    SearchOutcome outcome = SearchOutcome::Complete;
    std::size_t potentialPairs = 0;
    std::size_t bundles = 0;
    std::size_t buckets = 0;
    std::uint64_t combinations = 0; ///< bundles tried
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/correspondence/SearchResult.cpp")
