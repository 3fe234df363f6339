#include "protocol/nmea/Gga.h"

namespace hermes::nmea {

namespace {

constexpr double maxAge_s = 1e6;
constexpr int maxStation = 9999;

} // namespace

FieldFault decode(const Sentence &sentence, Gga &gga) {
    if (!sentence.is("GGA", 9)) // up to the altitude
        return {0, "GGA with 9 fields or more"};
    FieldReader read(sentence);
    gga = Gga();
    gga.time = read.time(1);
    gga.position = read.position(2);
    FieldReader aside(sentence); // the position does not depend on these
    gga.quality = aside.whole(6, 0, 9, "the quality, 0 to 9").value_or(0);
    gga.satellites = aside.whole(7, 0, maxSatellites, "a number of satellites");
    gga.hdop = aside.number(8, 0, maxHdop, "an HDOP from 0 to 9999");
    gga.altitude = aside.number(9, -maxMetres, maxMetres, "an altitude in metres");
    gga.separation = aside.number(11, -maxMetres, maxMetres, "a geoid separation in metres");
    gga.age_s = aside.number(13, 0, maxAge_s, "an age in seconds");
    gga.station = aside.whole(14, 0, maxStation, "a station, 0 to 9999");
    return gga.quality == 0 ? FieldFault() : read.fault(); // without a fix fields are filled with anything
}

std::optional<SentenceText> encode(const Gga &gga, std::string_view talker, const Decimals &decimals) {
    FieldWriter write(talker, "GGA");
    write.time(gga.time, decimals.seconds);
    write.position(gga.position, decimals.minutes);
    write.number(gga.quality, 1, 0, 0, 9);
    write.number(gga.satellites, 2, 0, 0, maxSatellites);
    write.number(gga.hdop, 0, 1, 0, maxHdop);
    write.number(gga.altitude, 0, 1, -maxMetres, maxMetres);
    write.letter('M');
    write.number(gga.separation, 0, 1, -maxMetres, maxMetres);
    write.letter('M');
    write.number(gga.age_s, 0, 1, 0, maxAge_s);
    write.number(gga.station, 4, 0, 0, maxStation);
    return write.finish();
}

} // namespace hermes::nmea
