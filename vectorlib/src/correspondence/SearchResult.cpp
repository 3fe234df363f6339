#include "vectorlib/correspondence/SearchResult.h"

namespace vectorlib {

VECTORLIB_BODY const char *describe(Fault fault) {
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

VECTORLIB_BODY const char *describe(SearchOutcome outcome) {
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

} // namespace vectorlib
