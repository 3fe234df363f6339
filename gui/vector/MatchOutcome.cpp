#include "gui/vector/MatchOutcome.h"

#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>

namespace hermes::vector {

using vectorlib::GlobalPairVerdict;
using vectorlib::RelationOutcome;
using vectorlib::SearchOutcome;
using vectorlib::SearchResult;
using vectorlib::Solution;

namespace {

/// Whether another accepted solution lies more than 0.5 m or 10 degrees from the first one.
bool haveRival(const SearchResult &found) {
    return std::any_of(found.solutions.begin(), found.solutions.end(), [&](const Solution &s) {
        const vectorlib::Transformation2D way = found.solutions[0].pose.inverse() * s.pose;
        return s.accepted && (way.translation().norm() > 0.5 || std::abs(way.alpha()) > 0.17);
    });
}

} // namespace

MatchOutcome outcomeOf(GlobalPairVerdict verdict) {
    switch (verdict) {
    case GlobalPairVerdict::Found:
        return MatchOutcome::Found;
    case GlobalPairVerdict::Ambiguous:
        return MatchOutcome::Ambiguous;
    case GlobalPairVerdict::OpenDirection:
        return MatchOutcome::OpenDirection;
    case GlobalPairVerdict::NothingFixed:
    case GlobalPairVerdict::NothingMoving:
        return MatchOutcome::TooLittle;
    case GlobalPairVerdict::TooUnlike:
        break;
    }
    return MatchOutcome::Nowhere;
}

MatchOutcome outcomeOf(RelationOutcome outcome) {
    switch (outcome) {
    case RelationOutcome::Matched:
        return MatchOutcome::Found;
    case RelationOutcome::Ambiguous:
        return MatchOutcome::Ambiguous;
    case RelationOutcome::OneDirection:
        return MatchOutcome::OpenDirection;
    case RelationOutcome::BadSettings:
        return MatchOutcome::BadSettings;
    case RelationOutcome::TooFewReference:
    case RelationOutcome::TooFewCurrent:
        return MatchOutcome::TooLittle;
    default:
        return MatchOutcome::Nowhere;
    }
}

std::string reasonOf(RelationOutcome outcome) {
    switch (outcome) {
    case RelationOutcome::TooFewReference:
        return "fewer than two usable segments in the static set";
    case RelationOutcome::TooFewCurrent:
        return "fewer than two usable segments in the dynamic set";
    case RelationOutcome::NoCommonRelation:
        return "the sets have no relation of segments in common";
    default:
        return describe(outcome);
    }
}

MatchOutcome outcomeOf(const SearchResult &found) {
    switch (found.outcome) {
    case SearchOutcome::Complete:
        break;
    case SearchOutcome::Cut:
    case SearchOutcome::TooManyPairs:
        return MatchOutcome::Unfinished;
    case SearchOutcome::BadSettings:
        return MatchOutcome::BadSettings;
    case SearchOutcome::NothingFixed:
    case SearchOutcome::NothingMoving:
        return MatchOutcome::TooLittle;
    case SearchOutcome::OneDirection:
        return MatchOutcome::OpenDirection;
    default:
        return MatchOutcome::Nowhere;
    }
    if (found.solutions.empty())
        return MatchOutcome::Nowhere;
    const Solution &first = found.solutions[0];
    return !first.accepted    ? first.fault == vectorlib::Fault::Reliability ? MatchOutcome::OpenDirection
                                                                             : MatchOutcome::Nowhere
           : haveRival(found) ? MatchOutcome::Ambiguous
                              : MatchOutcome::Found;
}

std::string reasonOf(const SearchResult &found) {
    if (found.outcome != SearchOutcome::Complete)
        return describe(found.outcome);
    if (found.solutions.empty())
        return "no combination of segments is a solution";
    return found.solutions[0].accepted ? "several motions fit alike" : describe(found.solutions[0].fault);
}

} // namespace hermes::vector
