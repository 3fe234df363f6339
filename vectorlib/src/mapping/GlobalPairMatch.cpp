#include "vectorlib/mapping/GlobalPairMatch.h"

namespace vectorlib {

VECTORLIB_BODY const char *describe(GlobalPairVerdict verdict) {
    switch (verdict) {
    case GlobalPairVerdict::Found:
        return "found";
    case GlobalPairVerdict::Ambiguous:
        return "several motions fit alike";
    case GlobalPairVerdict::OpenDirection:
        return "the scans slide on each other, as along a corridor";
    case GlobalPairVerdict::TooUnlike:
        return "no motion explains enough of what the scans show";
    case GlobalPairVerdict::NothingFixed:
        return "the static scan shows too few surfaces";
    case GlobalPairVerdict::NothingMoving:
        return "the dynamic scan shows too few surfaces";
    }
    return "";
}

} // namespace vectorlib
