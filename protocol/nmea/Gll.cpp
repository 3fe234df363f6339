#include "protocol/nmea/Gll.h"

namespace hermes::nmea {

FieldFault decode(const Sentence &sentence, Gll &gll) {
    if (!sentence.is("GLL", 6)) // up to the status
        return {0, "GLL with 6 fields or more"};
    FieldReader read(sentence);
    gll = Gll();
    gll.position = read.position(1);
    gll.time = read.time(5);
    const std::optional<char> status = read.letter(6, "AV", "the status, A or V");
    if (!status)
        read.fail(6, "the status, A or V");
    gll.valid = status == 'A';
    return status == 'V' ? FieldFault() : read.fault();
}

} // namespace hermes::nmea
