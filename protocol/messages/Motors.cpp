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
            .add("control", &MotionHold::control, "As in control.state");
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
                                   .mayBeMissing();
    return fields;
}

const Fields<PowerMessage> &fieldsOf(Of<PowerMessage>) {
    static const auto fields =
        Fields<PowerMessage>().add("controllers", &PowerMessage::controllers, "All").atMostElements(100);
    return fields;
}

} // namespace hermes
