#pragma once

#include "vectorlib/correspondence/SearchResult.h"
#include "vectorlib/mapping/GlobalPairMatcher.h"
#include "vectorlib/relations/RelationMatcher.h"

#include <algorithm>
#include <string>

namespace hermes::vector {

/// How a match of two sets ended: the same words whatever the method.
enum class MatchOutcome {
    Found,         ///< the first solution is to be trusted
    Ambiguous,     ///< several motions fit alike
    OpenDirection, ///< the sets slide on each other, as along a corridor
    Nowhere,       ///< no motion is good enough
    TooLittle,     ///< one of the sets shows too little to be matched
    Unfinished,    ///< a bound ended the search: there may be better solutions
    BadSettings    ///< a setting is not one that the method can work with
};

/// For programs.
inline const char *name(MatchOutcome outcome) {
    static constexpr const char *texts[] = {"found",      "ambiguous",  "open_direction", "nowhere",
                                            "too_little", "unfinished", "bad_settings"};
    return texts[static_cast<int>(outcome)]; // in the order of the enumeration
}

/// For people; what is known beyond it follows after a colon.
inline std::string describe(MatchOutcome outcome) {
    std::string text = name(outcome);
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
}

/// The outcome in these words; and for outcomes but Found the reason, for people, where the method's own
/// words do not tell it.
MatchOutcome outcomeOf(vectorlib::GlobalPairVerdict verdict);
MatchOutcome outcomeOf(vectorlib::RelationOutcome outcome);
std::string reasonOf(vectorlib::RelationOutcome outcome);
/// Accepted solutions over 0.5 m or 10 degrees from the first one make it ambiguous.
MatchOutcome outcomeOf(const vectorlib::SearchResult &found);
std::string reasonOf(const vectorlib::SearchResult &found);

} // namespace hermes::vector
