#include "protocol/messages/Processes.h"

#include "protocol/wire/Fields.h"

namespace hermes {

const Fields<ProcessEntry> &fieldsOf(Of<ProcessEntry>) {
    using E = ProcessEntry;
    static const auto fields = Fields<E>()
                                   .add("name", &E::name, "Of the process: letters, digits, space, and ._-")
                                   .with("pattern", "^[A-Za-z0-9_][A-Za-z0-9_. -]{0,63}$")
                                   .add("program", &E::program, "Path or name (hermes-NAME)")
                                   .with("minLength", 1)
                                   .mayBeMissing()
                                   .add("arguments", &E::arguments, "Command line")
                                   .mayBeMissing()
                                   .add("port", &E::port, "Where it accepts commands; 0: nowhere")
                                   .range(0, 65535)
                                   .mayBeMissing()
                                   .add("autostart", &E::autostart, "Starts with the supervisor")
                                   .mayBeMissing();
    return fields;
}

const Fields<ProcessStatus> &fieldsOf(Of<ProcessStatus>) {
    using S = ProcessStatus;
    static const auto fields = Fields<S>()
                                   .include(&S::entry)
                                   .add("state", &S::state, "Waiting: for its next start")
                                   .choices({"stopped", "running", "stopping", "waiting", "failed"})
                                   .add("pid", &S::pid, "Process id; 0: it does not run")
                                   .add("restarts", &S::restarts, "Since the supervisor began")
                                   .add("last_exit", &S::lastExit, "How it ended last, or empty")
                                   .mayBeMissing()
                                   .add("next_start_s", &S::nextStart_s, "Until then, while it waits", "s")
                                   .add("uptime_s", &S::uptime_s, "Since its start, while it runs", "s")
                                   .add("memory_bytes", &S::memory_bytes, "Resident, while it runs", "byte")
                                   .add("cpu", &S::cpu, "Share of one core, while it runs");
    return fields;
}

const Fields<ProcessesMessage> &fieldsOf(Of<ProcessesMessage>) {
    static const auto fields =
        Fields<ProcessesMessage>()
            .add("robot", &ProcessesMessage::robot, "What people call it")
            .add("processes", &ProcessesMessage::processes, "In the order of their start");
    return fields;
}

} // namespace hermes
