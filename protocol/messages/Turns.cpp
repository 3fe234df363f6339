#include "protocol/messages/Turns.h"

#include "protocol/wire/Fields.h"

namespace hermes {
namespace {

constexpr double latest = 1e10; // seconds: beyond it stamps lose their digits

} // namespace

const Fields<TurnHeader> &fieldsOf(Of<TurnHeader>) {
    static const auto fields =
        Fields<TurnHeader>()
            .add("turn", &TurnHeader::turn, "Counts the turns since the source was opened")
            .mayBeMissing()
            .add("stamp", &TurnHeader::stamp, "Of the first firing, since the Unix epoch", "s")
            .range(-latest, latest)
            .add("duration_s", &TurnHeader::duration_s, "From the first firing to the last", "s")
            .mayBeMissing()
            .add("partial", &TurnHeader::partial, "The first, the last, or one that was cut")
            .mayBeMissing()
            .add("rays", &TurnHeader::rays, "Fired in a full turn, with or without a return")
            .range(0, ScanMessage::maxPoints)
            .add("lost_packets", &TurnHeader::lostPackets, "In this turn")
            .mayBeMissing()
            .add("frame", &TurnHeader::frame, "What the coordinates are relative to")
            .mayBeMissing()
            .add("replayed", &TurnHeader::replayed, "It was recorded, and says nothing of the robot of now")
            .mayBeMissing();
    return fields;
}

const Fields<ScanMessage> &fieldsOf(Of<ScanMessage>) {
    static const auto fields =
        Fields<ScanMessage>()
            .include(&ScanMessage::header)
            .add("laser", &ScanMessage::laser, "Whose ring it is")
            .mayBeMissing()
            .add("x", &ScanMessage::x, "Of each point, counter-clockwise: ahead of the sensor", "m")
            .atMostElements(ScanMessage::maxPoints)
            .add("y", &ScanMessage::y, "To the left of the sensor", "m")
            .atMostElements(ScanMessage::maxPoints)
            .add("t", &ScanMessage::t, "After the stamp", "s")
            .atMostElements(ScanMessage::maxPoints)
            .add("intensity", &ScanMessage::intensity, "Of the return, 0 to 255")
            .atMostElements(ScanMessage::maxPoints)
            .mayBeMissing();
    return fields;
}

const Fields<CloudMessage> &fieldsOf(Of<CloudMessage>) {
    static const auto fields =
        Fields<CloudMessage>()
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
    return fields;
}

} // namespace hermes
