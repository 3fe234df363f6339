#include "protocol/messages/Setup.h"

#include "protocol/wire/Fields.h"

namespace hermes {

const Fields<FoundSerial> &fieldsOf(Of<FoundSerial>) {
    using S = FoundSerial;
    static const auto fields =
        Fields<S>()
            .add("path", &S::path, "A name that stays the same, where there is one")
            .add("device", &S::device, "Its name of today")
            .add("about", &S::about, "What the system knows of the adapter, or empty")
            .mayBeMissing()
            .add("kind", &S::kind,
                 "A RoboClaw; NMEA sentences; something else that talks by itself; something that answers, "
                 "but not as a RoboClaw; silent, also when asked; silent and not asked; in use by another "
                 "program, and left alone; cannot be opened")
            .choices(S::kinds())
            .add("text", &S::text, "The version of a controller, a sentence, or why there is nothing")
            .mayBeMissing()
            .add("baud", &S::baud, "At which it was understood; 0: it was not")
            .mayBeMissing()
            .add("addresses", &S::addresses, "At which a controller answered, 128 to 135")
            .mayBeMissing()
            .add("any_address", &S::anyAddress, "It answers at all of them, as a controller on USB does")
            .mayBeMissing()
            .add("simulated", &S::simulated, "A process of the supervisor is at the far end")
            .mayBeMissing();
    return fields;
}

const Fields<FoundLidar> &fieldsOf(Of<FoundLidar>) {
    using L = FoundLidar;
    static const auto fields =
        Fields<L>()
            .add("address", &L::address, "Whence its packets came")
            .add("model", &L::model, "As VLP-16; empty: an unknown one")
            .add("key", &L::key, "As the setting decode.model has it; empty: an unknown one")
            .mayBeMissing()
            .add("port", &L::port, "UDP port at which they came")
            .add("rate_hz", &L::rate_hz, "Data packets a second", "Hz")
            .mayBeMissing()
            .add("positions", &L::positions, "It sends position packets, too")
            .mayBeMissing()
            .add("simulated", &L::simulated, "It is the simulator of the supervisor")
            .mayBeMissing();
    return fields;
}

const Fields<Findings> &fieldsOf(Of<Findings>) {
    using F = Findings;
    static const auto fields =
        Fields<F>()
            .add("serial", &F::serial, "The serial lines of this computer")
            .add("lidars", &F::lidars, "Whose packets came")
            .add("problems", &F::problems, "What could not be looked for, and why")
            .mayBeMissing()
            .add("restarted", &F::restarted, "Processes that were stopped for it and started again")
            .mayBeMissing();
    return fields;
}

const Fields<SettingChange> &fieldsOf(Of<SettingChange>) {
    using C = SettingChange;
    static const auto fields =
        Fields<C>()
            .add("daemon", &C::daemon, "Whose settings file")
            .add("path", &C::path, "Of the setting, as controllers.1.url")
            .add("now", &C::now, "Its value in the file, as JSON; empty: the default holds")
            .mayBeMissing()
            .add("value", &C::value, "That it would have; empty: the default")
            .mayBeMissing();
    return fields;
}

const Fields<Proposal> &fieldsOf(Of<Proposal>) {
    using P = Proposal;
    static const auto fields =
        Fields<P>()
            .add("settings", &P::settings,
                 "By daemons: what changes in the settings of each, or in those of the sample")
            .add("changes", &P::changes, "All that would differ in the settings files")
            .mayBeMissing()
            .add("notes", &P::notes, "What a person should know of it");
    return fields;
}

const Fields<Applied> &fieldsOf(Of<Applied>) {
    using A = Applied;
    static const auto fields =
        Fields<A>()
            .add("files", &A::files, "That were written")
            .add("restarted", &A::restarted, "Processes that ran, or start with the supervisor")
            .add("notes", &A::notes, "What a person should know of it")
            .mayBeMissing();
    return fields;
}

} // namespace hermes
