#pragma once

#include "vectorlib/correspondence/Match.h"
#include "vectorlib/observation/Discrepancy.h"

#include <cstdint>

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
inline const char *describe(Fault fault) {
    switch (fault) {
    case Fault::None:
        return "accepted";
    case Fault::Reliability:
        return "the directions of its pairs are too much alike to fix the place";
    case Fault::Ambiguity:
        return "its pairs contradict each other";
    case Fault::MatchedShare:
        return "too little of the dynamic set has partners";
    case Fault::NoEvidence:
        return "too little of the static set would be seen from there";
    case Fault::Discrepancy:
        return "what would be seen from there differs from what was seen";
    case Fault::NotPermitted:
        return "its transformation is not in the permitted set";
    }
    return "";
}

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
inline const char *describe(SearchOutcome outcome) {
    switch (outcome) {
    case SearchOutcome::Complete:
        return "every combination was considered";
    case SearchOutcome::Cut:
        return "the bound on combinations ended the search: there may be better solutions";
    case SearchOutcome::BadSettings:
        return "the expected transformation, a threshold or a bound is negative, zero where it must not be, "
               "or "
               "not finite";
    case SearchOutcome::NothingFixed:
        return "no usable segment in the static set within reach";
    case SearchOutcome::NothingMoving:
        return "no usable segment in the dynamic set";
    case SearchOutcome::NoPotentialPair:
        return "no permitted transformation brings any two segments together";
    case SearchOutcome::TooManyPairs:
        return "more pairs of segments near each other than the bounds on pairs: permit less motion";
    case SearchOutcome::OneDirection:
        return "all potential pairs are parallel: the shift along them is not known";
    case SearchOutcome::NoCombination:
        return "no two directions agree on a transformation";
    }
    return "";
}

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
