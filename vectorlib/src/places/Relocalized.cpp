#include "vectorlib/places/Relocalized.h"

namespace vectorlib {

VECTORLIB_BODY const char *describe(PlaceFault fault) {
    switch (fault) {
    case PlaceFault::None:
        return "accepted";
    case PlaceFault::Reliability:
        return "the directions of the walls are too much alike to fix the place";
    case PlaceFault::Explained:
        return "too little of the scan lies on walls of the map";
    case PlaceFault::Contradicted:
        return "what would be seen from there differs from what was seen";
    case PlaceFault::Doubtful:
        return "too little speaks for it";
    case PlaceFault::Alike:
        return "another place fits alike";
    }
    return "";
}

VECTORLIB_BODY std::string Relocalized::text() const {
    const auto count = [](std::size_t n) { return std::to_string(n); };
    switch (outcome) {
    case Outcome::Found:
        return "found";
    case Outcome::NoScan:
        return "no scan was taken yet";
    case Outcome::NoMap:
        return "the map is empty";
    case Outcome::TooLittle:
        return "the last scan shows fewer than two line segments";
    case Outcome::Nowhere:
        return places.empty() ? "the scan fits nowhere in the map"
                              : std::string("no place in the map is good enough; the best: ") +
                                    describe(places.front().fault);
    case Outcome::Ambiguous:
        return count(alike) + " places in the map fit alike";
    case Outcome::Unfinished:
        return "only " + count(searched) + " of " + count(parts) + " parts of the search were done";
    }
    return {};
}

VECTORLIB_BODY const char *name(Relocalized::Outcome outcome) {
    switch (outcome) {
    case Relocalized::Outcome::Found:
        return "found";
    case Relocalized::Outcome::NoScan:
        return "no_scan";
    case Relocalized::Outcome::NoMap:
        return "no_map";
    case Relocalized::Outcome::TooLittle:
        return "too_little";
    case Relocalized::Outcome::Nowhere:
        return "nowhere";
    case Relocalized::Outcome::Ambiguous:
        return "ambiguous";
    case Relocalized::Outcome::Unfinished:
        return "unfinished";
    }
    return "";
}

} // namespace vectorlib
