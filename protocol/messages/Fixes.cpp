#include "protocol/messages/Fixes.h"

#include "protocol/wire/Fields.h"

namespace hermes {

Fields<FixValues> fieldsOf(Of<FixValues>) {
    using F = FixValues;
    return Fields<F>()
        .add("stamp", &F::stamp, "When it came, since the Unix epoch", "s")
        .add("mono", &F::mono, "The stamp on a clock that never jumps", "s")
        .addOrNull("time", &F::time, "Of the fix by the satellites, since the Unix epoch", "s")
        .add("valid", &F::valid, "The receiver vouches for it")
        .addOrNull("lat_deg", &F::lat_deg, "North", "deg")
        .addOrNull("lon_deg", &F::lon_deg, "East", "deg")
        .addOrNull("alt", &F::alt, "Above mean sea level", "m")
        .addOrNull("quality", &F::quality, "As of GGA")
        .addOrNull("satellites", &F::satellites, "Used")
        .addOrNull("hdop", &F::hdop, "Dilution of the horizontal position")
        .addOrNull("speed", &F::speed, "Over ground", "m/s")
        .addOrNull("course_deg", &F::course_deg, "Clockwise from north", "deg");
}

Fields<FixMessage> fieldsOf(Of<FixMessage>) {
    return Fields<FixMessage>()
        .add("port", &FixMessage::port, "That it came from")
        .include(&FixMessage::values)
        .addMaybe("replayed", &FixMessage::replayed, "It was recorded, and says nothing of the robot of now");
}

} // namespace hermes
