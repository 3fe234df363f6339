#include "protocol/messages/Setup.h"

#include "protocol/wire/Fields.h"

namespace hermes {

Fields<FoundSerial> fieldsOf(Of<FoundSerial>) {
    using S = FoundSerial;
    return Fields<S>()
        .add("path", &S::path, "A name that stays the same, where there is one")
        .add("device", &S::device, "Its name of today")
        .addMaybe("about", &S::about, "What the system knows of the adapter, or empty")
        .add("kind", &S::kind,
             "A RoboClaw; an Arduino with the text protocol of a base; a VESC; an OpenCR; a Roboteq; NMEA "
             "sentences; a laser scanner of one plane; something else that talks by itself; something that "
             "answers, but not as a RoboClaw; silent, also when asked; silent and not asked; in use by "
             "another "
             "program, and left alone; cannot be opened")
        .choices(S::kinds())
        .addMaybe("text", &S::text, "The version of a controller, a sentence, or why there is nothing")
        .addMaybe("model", &S::model, "Of a scanner, as the setting scanner.model has it")
        .addMaybe("baud", &S::baud, "At which it was understood; 0: it was not")
        .addMaybe("addresses", &S::addresses, "At which a controller answered, 128 to 135")
        .addMaybe("any_address", &S::anyAddress, "It answers at all of them, as a controller on USB does")
        .addMaybe("simulated", &S::simulated, "A process of the supervisor is at the far end");
}

Fields<FoundLidar> fieldsOf(Of<FoundLidar>) {
    using L = FoundLidar;
    return Fields<L>()
        .add("address", &L::address, "Whence its packets came")
        .add("model", &L::model, "As VLP-16; empty: an unknown one")
        .addMaybe("key", &L::key, "As the setting decode.model has it; empty: an unknown one")
        .add("port", &L::port, "UDP port at which they came")
        .addMaybe("rate_hz", &L::rate_hz, "Data packets a second", "Hz")
        .addMaybe("positions", &L::positions, "It sends position packets, too")
        .addMaybe("simulated", &L::simulated, "It is the simulator of the supervisor");
}

Fields<Findings> fieldsOf(Of<Findings>) {
    using F = Findings;
    return Fields<F>()
        .add("serial", &F::serial, "The serial lines of this computer")
        .add("lidars", &F::lidars, "Whose packets came")
        .addMaybe("problems", &F::problems, "What could not be looked for, and why")
        .addMaybe("restarted", &F::restarted, "Processes that were stopped for it and started again");
}

Fields<SettingChange> fieldsOf(Of<SettingChange>) {
    using C = SettingChange;
    return Fields<C>()
        .add("daemon", &C::daemon, "Whose settings file")
        .add("path", &C::path, "Of the setting, as controllers.1.url")
        .addMaybe("now", &C::now, "Its value in the file, as JSON; empty: the default holds")
        .addMaybe("value", &C::value, "That it would have; empty: the default");
}

Fields<Proposal> fieldsOf(Of<Proposal>) {
    using P = Proposal;
    return Fields<P>()
        .add("settings", &P::settings,
             "By daemons: what changes in the settings of each, or in those of the sample")
        .addMaybe("changes", &P::changes, "All that would differ in the settings files")
        .add("notes", &P::notes, "What a person should know of it");
}

Fields<Applied> fieldsOf(Of<Applied>) {
    using A = Applied;
    return Fields<A>()
        .add("files", &A::files, "That were written")
        .add("restarted", &A::restarted, "Processes that ran, or start with the supervisor")
        .addMaybe("notes", &A::notes, "What a person should know of it");
}

} // namespace hermes
