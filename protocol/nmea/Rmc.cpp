#include "protocol/nmea/Rmc.h"

#include <cmath>

namespace hermes::nmea {

FieldFault decode(const Sentence &sentence, Rmc &rmc) {
    if (!sentence.is("RMC", 9)) // up to the date
        return {0, "RMC with 9 fields or more"};
    FieldReader read(sentence);
    rmc = Rmc();
    rmc.time = read.time(1);
    const std::optional<char> status = read.letter(2, "AV", "the status, A or V");
    if (!status)
        read.fail(2, "the status, A or V");
    rmc.valid = status == 'A';
    rmc.position = read.position(3);
    FieldReader aside(sentence); // the position does not depend on these
    rmc.speed = aside.number(7, 0, maxKnots, "a speed from 0 to 9999 knots");
    if (rmc.speed)
        rmc.speed = *rmc.speed * knot;
    rmc.course_deg = aside.number(8, 0, 360, "a course from 0 to 360 degrees");
    rmc.date = aside.date(9);
    const auto variation = aside.number(10, 0, 180, "a magnetic variation from 0 to 180 degrees");
    if (const auto side = aside.letter(11, "EW", "E or W"); variation && side)
        rmc.variation_deg = side == 'W' ? -*variation : *variation;
    rmc.mode = aside.letter(12, "ABCDEFGHIJKLMNOPQRSTUVWXYZ", "the mode, a letter");
    return status == 'V' ? FieldFault()
                         : read.fault(); // receivers without a fix fill their fields with anything
}

std::optional<SentenceText> encode(const Rmc &rmc, std::string_view talker, const Decimals &decimals) {
    FieldWriter write(talker, "RMC");
    write.time(rmc.time, decimals.seconds);
    write.letter(rmc.valid ? 'A' : 'V');
    write.position(rmc.position, decimals.minutes);
    write.number(rmc.speed ? std::optional(*rmc.speed / knot) : std::nullopt, 5, 1, 0, maxKnots);
    // 359.97 would be rounded up to a whole turn
    const auto course = rmc.course_deg && *rmc.course_deg >= 359.95 && *rmc.course_deg <= 360
                            ? std::optional(0.0)
                            : rmc.course_deg;
    write.number(course, 5, 1, 0, 360);
    write.date(rmc.date);
    write.number(rmc.variation_deg ? std::optional(std::abs(*rmc.variation_deg)) : std::nullopt, 5, 1, 0,
                 180);
    write.letter(rmc.variation_deg ? std::optional(*rmc.variation_deg < 0 ? 'W' : 'E') : std::nullopt);
    if (rmc.mode)
        write.letter(rmc.mode);
    return write.finish();
}

} // namespace hermes::nmea
