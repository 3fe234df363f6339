#include "vectorlib/relations/RelationMatch.h"

namespace vectorlib {

VECTORLIB_BODY const char *describe(RelationOutcome outcome) {
    switch (outcome) {
    case RelationOutcome::Matched:
        return "matched";
    case RelationOutcome::BadSettings:
        return "a setting is negative, zero where it must not be, too large or not a number";
    case RelationOutcome::TooFewReference:
        return "fewer than two usable segments in the reference scan";
    case RelationOutcome::TooFewCurrent:
        return "fewer than two usable segments in the current scan";
    case RelationOutcome::NoCommonRelation:
        return "no relation of the current scan is found in the reference scan";
    case RelationOutcome::OnePair:
        return "only one pair of segments matches";
    case RelationOutcome::OneDirection:
        return "the directions of the matching segments are too much alike to fix the place";
    case RelationOutcome::Contradiction:
        return "the matching segments agree on a rotation, but on no place";
    case RelationOutcome::Unspecific:
        return "too little matches to tell the place from others like it: a corner alone fits any corner";
    case RelationOutcome::Ambiguous:
        return "another place fits nearly as well";
    }
    return "";
}

} // namespace vectorlib
