#include "protocol/nmea/Gns.h"

#include <algorithm>

namespace hermes::nmea {

namespace {

constexpr int modeField = 6;
constexpr const char *modeExpected = "the mode, a letter of ADEFMNPRS for each constellation";

struct Mode {
    char letter;
    int quality; ///< as GGA writes it
};
/// The best first.
constexpr Mode modes[] = {{'R', 4}, {'F', 5}, {'P', 3}, {'D', 2}, {'A', 1},
                          {'E', 6}, {'M', 7}, {'S', 8}, {'N', 0}};

std::optional<int> qualityOf(FieldReader &read, std::string_view letters) {
    if (letters.empty())
        return std::nullopt;
    if (letters.find_first_not_of("ADEFMNPRS") != std::string_view::npos)
        read.fail(modeField, modeExpected);
    const Mode *best = std::find_if(std::begin(modes), std::end(modes) - 1, [&](const Mode &mode) {
        return letters.find(mode.letter) != std::string_view::npos;
    });
    return best->quality;
}

} // namespace

FieldFault decode(const Sentence &sentence, Gns &gns) {
    if (!sentence.is("GNS", 9)) // up to the altitude
        return {0, "GNS with 9 fields or more"};
    FieldReader read(sentence);
    gns = Gns();
    gns.time = read.time(1);
    gns.position = read.position(2);
    gns.quality = qualityOf(read, sentence.field(modeField));
    if (gns.position && !gns.quality)
        read.fail(modeField, modeExpected);
    FieldReader aside(sentence); // the position does not depend on these
    gns.satellites = aside.whole(7, 0, maxSatellites, "a number of satellites");
    gns.hdop = aside.number(8, 0, maxHdop, "an HDOP from 0 to 9999");
    gns.altitude = aside.number(9, -maxMetres, maxMetres, "an altitude in metres");
    return gns.quality == 0 ? FieldFault() : read.fault();
}

} // namespace hermes::nmea
