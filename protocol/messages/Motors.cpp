#include "protocol/messages/Motors.h"

#include "protocol/wire/Fields.h"

namespace hermes {

Fields<LeaseState> fieldsOf(Of<LeaseState>) {
    using L = LeaseState;
    return Fields<L>()
        .add("held", &L::held, "A client holds the control")
        .addOrNull("holder", &L::holder, "Its name")
        .addMaybe("remaining_s", &L::remaining_s, "Without a further command", "s")
        .addOrNull("wanted", &L::wanted, "Name of the client that asked the holder for it last");
}

Fields<MotionHold> fieldsOf(Of<MotionHold>) {
    return Fields<MotionHold>()
        .add("latched", &MotionHold::latched, "Reason of each cause that holds until motor.reset_estop")
        .add("control", &MotionHold::control, "As in control.state")
        .addMaybe("halted", &MotionHold::halted, "Why the robot halted last; empty while it follows commands")
        .addMaybe("cause", &MotionHold::cause,
                  "The same in a word: driver (who drove stopped), stop (others did), estop, time-out, "
                  "take-over, client gone, release, reset, settings, gap (the program stood still), "
                  "shutdown, controller (one is not ready), or the fault that is latched");
}

Fields<StandConfirmation> fieldsOf(Of<StandConfirmation>) {
    using S = StandConfirmation;
    return Fields<S>()
        .add("confirmed", &S::confirmed,
             "All have acknowledged a set-point of zero, and their encoders have not moved since")
        .add("text", &S::text, "Which have not, and why; or empty");
}

Fields<ControllerPower> fieldsOf(Of<ControllerPower>) {
    using C = ControllerPower;
    return Fields<C>()
        .add("ready", &C::ready, "It answers and has told all of this")
        .add("battery_v", &C::battery_v, "Main battery", "V")
        .addMaybe("logic_v", &C::logic_v, "Logic battery", "V")
        .add("current_a", &C::current_a, "Of both motors", "A")
        .add("temperature_c", &C::temperature_c, "Of the controller", "degC")
        .addMaybe("status", &C::status, "Bits of errors and warnings")
        .addMaybe("status_texts", &C::statusTexts, "What they mean")
        .add("duty", &C::duty, "Of both motors, -1 to 1");
}

Fields<BatteryState> fieldsOf(Of<BatteryState>) {
    using B = BatteryState;
    return Fields<B>()
        .add("charge", &B::charge, "Share of the capacity that is left, 0 to 1")
        .add("charge_deviation", &B::chargeDeviation, "Standard deviation of charge")
        .add("current_a", &B::current_a, "Of motors (mean of the last minute), computers and sensors", "A")
        .add("left_s", &B::left_s, "At that current, until only the reserve is left; 48 h at most", "s")
        .add("left_least_s", &B::leftLeast_s, "The same, with a charge that is one deviation less", "s")
        .add("reason", &B::reason, "Why not all of this is known, or empty");
}

Fields<PowerMessage> fieldsOf(Of<PowerMessage>) {
    return Fields<PowerMessage>()
        .add("controllers", &PowerMessage::controllers, "All")
        .atMostElements(100)
        .addMaybe("battery", &PowerMessage::battery, "How full it is");
}

Fields<WheelMessage> fieldsOf(Of<WheelMessage>) {
    using W = WheelMessage;
    return Fields<W>()
        .add("target", &W::target, "What was commanded", "rad/s")
        .add("set_point", &W::setPoint, "On the way there", "rad/s")
        .add("speed", &W::speed, "As measured", "rad/s")
        .add("angle", &W::angle, "Since the start", "rad");
}

Fields<WheelsMessage> fieldsOf(Of<WheelsMessage>) {
    Fields<WheelsMessage> fields;
    for (std::size_t i = 0; i < WheelsMessage::count; ++i)
        fields.add(WheelsMessage::names[i], WheelsMessage::wheels()[i],
                   "Positive turns drive the robot forward; of omni wheels counter-clockwise");
    return fields
        .add("steering", &WheelsMessage::steering, "Of a steered axle, to the left, as commanded", "rad")
        .add("slip", &WheelsMessage::slip, "What no motion of a rigid robot explains", "m/s")
        .add("target", &WheelsMessage::target, "The robot's velocity that was commanded");
}

} // namespace hermes
