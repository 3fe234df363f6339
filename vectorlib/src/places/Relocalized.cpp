#include "vectorlib/places/Relocalized.h"

namespace vectorlib {

VECTORLIB_BODY const char *describe(PlaceFault fault) {
    static constexpr const char *texts[] = {"accepted",
                                            "the directions of the walls are too much alike to fix the place",
                                            "too little of the scan lies on walls of the map",
                                            "what would be seen from there differs from what was seen",
                                            "too little speaks for it",
                                            "another place fits alike"};
    return texts[static_cast<int>(fault)]; // in the order of the enumeration
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
    static constexpr const char *texts[] = {"found",   "no_scan",   "no_map",    "too_little",
                                            "nowhere", "ambiguous", "unfinished"};
    return texts[static_cast<int>(outcome)]; // in the order of the enumeration
}

} // namespace vectorlib
