#include "protocol/nmea/Zda.h"

namespace hermes::nmea {

namespace {

constexpr const char *dateExpected = "day, month and year as numbers: all three, or none";

} // namespace

FieldFault decode(const Sentence &sentence, Zda &zda) {
    if (!sentence.is("ZDA", 4)) // up to the year
        return {0, "ZDA with 4 fields or more"};
    FieldReader read(sentence);
    zda = Zda();
    zda.time = read.time(1);
    FieldReader aside(sentence); // a time without a date is one, too
    const std::optional<int> day = aside.whole(2, 1, 31, dateExpected);
    const std::optional<int> month = aside.whole(3, 1, 12, dateExpected);
    const std::optional<int> year = aside.whole(4, 1970, 9999, dateExpected);
    if (day && month && year && isValid(Date{*year, *month, *day}))
        zda.date = Date{*year, *month, *day};
    return read.fault();
}

} // namespace hermes::nmea
