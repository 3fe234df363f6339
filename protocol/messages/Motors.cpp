#include "protocol/messages/Motors.h"

#include "protocol/wire/Fields.h"

namespace hermes {

const Fields<LeaseState> &fieldsOf(Of<LeaseState>) {
    using L = LeaseState;
    static const auto fields =
        Fields<L>()
            .add("held", &L::held, "A client holds the control")
            .add("holder", &L::holder, "Its name")
            .orNull()
            .add("remaining_s", &L::remaining_s, "Without a further command", "s")
            .mayBeMissing()
            .add("wanted", &L::wanted, "Name of the client that asked the holder for it last")
            .orNull()
            .mayBeMissing();
    return fields;
}

const Fields<MotionHold> &fieldsOf(Of<MotionHold>) {
    static const auto fields =
        Fields<MotionHold>()
            .add("latched", &MotionHold::latched, "Reason of each cause that holds until motor.reset_estop")
            .add("control", &MotionHold::control, "As in control.state")
            .add("halted", &MotionHold::halted, "Why the robot halted last; empty while it follows commands")
            .mayBeMissing()
            .add("cause", &MotionHold::cause,
                 "The same in a word: driver (who drove stopped), stop (others did), estop, time-out, "
                 "take-over, client gone, release, reset, "
                 "settings, gap (the program stood still), shutdown, controller (one is not ready), or the "
                 "fault that "
                 "is latched")
            .mayBeMissing();
    return fields;
}

const Fields<StandConfirmation> &fieldsOf(Of<StandConfirmation>) {
    using S = StandConfirmation;
    static const auto fields =
        Fields<S>()
            .add("confirmed", &S::confirmed,
                 "All have acknowledged a set-point of zero, and their encoders have not moved since")
            .add("text", &S::text, "Which have not, and why; or empty");
    return fields;
}

const Fields<ControllerPower> &fieldsOf(Of<ControllerPower>) {
    using C = ControllerPower;
    static const auto fields = Fields<C>()
                                   .add("ready", &C::ready, "It answers and has told all of this")
                                   .add("battery_v", &C::battery_v, "Main battery", "V")
                                   .add("logic_v", &C::logic_v, "Logic battery", "V")
                                   .mayBeMissing()
                                   .add("current_a", &C::current_a, "Of both motors", "A")
                                   .add("temperature_c", &C::temperature_c, "Of the controller", "degC")
                                   .add("status", &C::status, "Bits of errors and warnings")
                                   .mayBeMissing()
                                   .add("status_texts", &C::statusTexts, "What they mean")
                                   .mayBeMissing()
                                   .add("duty", &C::duty, "Of both motors, -1 to 1")
                                   .mayBeMissing();
    return fields;
}

const Fields<BatteryState> &fieldsOf(Of<BatteryState>) {
    using B = BatteryState;
    static const auto fields =
        Fields<B>()
            .add("charge", &B::charge, "Share of the capacity that is left, 0 to 1")
            .mayBeMissing()
            .add("charge_deviation", &B::chargeDeviation, "Standard deviation of charge")
            .mayBeMissing()
            .add("current_a", &B::current_a, "Of motors (mean of the last minute), computers and sensors",
                 "A")
            .mayBeMissing()
            .add("left_s", &B::left_s, "At that current, until only the reserve is left; 48 h at most", "s")
            .mayBeMissing()
            .add("left_least_s", &B::leftLeast_s, "The same, with a charge that is one deviation less", "s")
            .mayBeMissing()
            .add("reason", &B::reason, "Why not all of this is known, or empty");
    return fields;
}

const Fields<PowerMessage> &fieldsOf(Of<PowerMessage>) {
    static const auto fields = Fields<PowerMessage>()
                                   .add("controllers", &PowerMessage::controllers, "All")
                                   .atMostElements(100)
                                   .add("battery", &PowerMessage::battery, "How full it is")
                                   .mayBeMissing();
    return fields;
}

} // namespace hermes
