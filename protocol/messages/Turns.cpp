#include "protocol/messages/Turns.h"

#include "protocol/wire/Fields.h"

namespace hermes {
namespace {

constexpr double latest = 1e10; // seconds: beyond it stamps lose their digits

} // namespace

Fields<TurnHeader> fieldsOf(Of<TurnHeader>) {
    return Fields<TurnHeader>()
        .addMaybe("turn", &TurnHeader::turn, "Counts the turns since the source was opened")
        .add("stamp", &TurnHeader::stamp, "Of the first firing, since the Unix epoch", "s")
        .range(-latest, latest)
        .addMaybe("duration_s", &TurnHeader::duration_s, "From the first firing to the last", "s")
        .addMaybe("partial", &TurnHeader::partial, "The first, the last, or one that was cut")
        .add("rays", &TurnHeader::rays, "Fired in a full turn, with or without a return")
        .range(0, ScanMessage::maxPoints)
        .addMaybe("lost_packets", &TurnHeader::lostPackets, "In this turn")
        .addMaybe("frame", &TurnHeader::frame, "What the coordinates are relative to")
        .addMaybe("replayed", &TurnHeader::replayed, "It was recorded, and says nothing of the robot of now")
        .add("clock", &TurnHeader::clock,
             "That the stamp is of: the sensor's, which a GPS sets (gps) or nobody does (sensor), or the "
             "host's")
        .choices({"gps", "sensor", "host"})
        .add("clock_error_s", &TurnHeader::clockError_s, "How far the stamp may be off, by the host's clock",
             "s");
}

Fields<ScanMessage> fieldsOf(Of<ScanMessage>) {
    return Fields<ScanMessage>()
        .include(&ScanMessage::header)
        .addMaybe("laser", &ScanMessage::laser, "Whose ring it is")
        .add("x", &ScanMessage::x, "Of each point, counter-clockwise: ahead of the sensor", "m")
        .atMostElements(ScanMessage::maxPoints)
        .add("y", &ScanMessage::y, "To the left of the sensor", "m")
        .atMostElements(ScanMessage::maxPoints)
        .add("t", &ScanMessage::t, "After the stamp", "s")
        .atMostElements(ScanMessage::maxPoints)
        .addMaybe("intensity", &ScanMessage::intensity, "Of the return, 0 to 255")
        .atMostElements(ScanMessage::maxPoints);
}

Fields<CloudMessage> fieldsOf(Of<CloudMessage>) {
    return Fields<CloudMessage>()
        .include(&CloudMessage::header)
        .add("model", &CloudMessage::model, "Of the sensor")
        .add("x", &CloudMessage::x, "Of each point, in the order of measuring: ahead of the sensor", "m")
        .atMostElements(ScanMessage::maxPoints)
        .add("y", &CloudMessage::y, "To the left", "m")
        .atMostElements(ScanMessage::maxPoints)
        .add("z", &CloudMessage::z, "Up", "m")
        .atMostElements(ScanMessage::maxPoints)
        .add("laser", &CloudMessage::laser, "That fired")
        .atMostElements(ScanMessage::maxPoints)
        .add("intensity", &CloudMessage::intensity, "Of the return, 0 to 255")
        .atMostElements(ScanMessage::maxPoints);
}

} // namespace hermes
