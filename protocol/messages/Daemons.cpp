#include "protocol/messages/Daemons.h"
#include "protocol/wire/Fields.h"

namespace hermes {

Fields<ProcessEntry> fieldsOf(Of<ProcessEntry>) {
    using E = ProcessEntry;
    return Fields<E>()
        .add("name", &E::name, "Of the process: letters, digits, space, and ._-")
        .with("pattern", "^[A-Za-z0-9_][A-Za-z0-9_. -]{0,63}$")
        .addMaybe("program", &E::program, "Path or name (hermes-NAME)")
        .with("minLength", 1)
        .addMaybe("arguments", &E::arguments, "Command line")
        .addMaybe("port", &E::port, "Where it accepts commands; 0: nowhere")
        .range(0, 65535)
        .addMaybe("autostart", &E::autostart, "Starts with the supervisor");
}

Fields<ProcessStatus> fieldsOf(Of<ProcessStatus>) {
    using S = ProcessStatus;
    return Fields<S>()
        .include(&S::entry)
        .add("state", &S::state, "Waiting: for its next start")
        .choices({"stopped", "running", "stopping", "waiting", "failed"})
        .add("pid", &S::pid, "Process id; 0: it does not run")
        .add("restarts", &S::restarts, "Since the supervisor began")
        .addMaybe("last_exit", &S::lastExit, "How it ended last, or empty")
        .add("next_start_s", &S::nextStart_s, "Until then, while it waits", "s")
        .add("uptime_s", &S::uptime_s, "Since its start, while it runs", "s")
        .add("memory_bytes", &S::memory_bytes, "Resident, while it runs", "byte")
        .add("cpu", &S::cpu, "Share of one core, while it runs");
}

Fields<ProcessesMessage> fieldsOf(Of<ProcessesMessage>) {
    return Fields<ProcessesMessage>()
        .add("robot", &ProcessesMessage::robot, "What people call it")
        .add("processes", &ProcessesMessage::processes, "In the order of their start");
}

Fields<RobotIdentity> fieldsOf(Of<RobotIdentity>) {
    return Fields<RobotIdentity>()
        .add("id", &RobotIdentity::id, "A UUID: the same as long as the robot is")
        .add("name", &RobotIdentity::name, "What people call it");
}

Fields<DaemonInfo> fieldsOf(Of<DaemonInfo>) {
    using I = DaemonInfo;
    return Fields<I>()
        .add("name", &I::name, "As in the program hermes-NAME")
        .addMaybe("title", &I::title, "For people")
        .addMaybe("version", &I::version, "Of the program")
        .addMaybe("protocol", &I::protocol, "Version of the rules by which it speaks")
        .addMaybe("description_hash", &I::descriptionHash, "Changes with what rpc.discover gives")
        .addMaybe("host", &I::host, "Where it runs")
        .addMaybe("pid", &I::pid, "Of its process")
        .addMaybe("listen", &I::listen, "URLs at which commands are accepted")
        .addMaybe("started", &I::started, "Since the Unix epoch", "s")
        .addMaybe("uptime_s", &I::uptime_s, "Since it started", "s")
        .addMaybe("role", &I::role, "Of who asks: what it may do")
        .add("robot", &I::robot, "Of which robot it is, where it was told");
}

Fields<HealthItem> fieldsOf(Of<HealthItem>) {
    using H = HealthItem;
    return Fields<H>()
        .add("name", &H::name, "What it is about")
        .add("level", &H::level, "error: does not work; stale: not heard of in time")
        .choices({"ok", "warn", "error", "stale"})
        .addMaybe("message", &H::message, "For people")
        .addMaybe("values", &H::values, "What stands behind the message")
        .addMaybe("age_s", &H::age_s, "Since it was looked at", "s");
}

Fields<DaemonStatus> fieldsOf(Of<DaemonStatus>) {
    using S = DaemonStatus;
    return Fields<S>()
        .add("state", &S::state, "degraded: works, but a health item is at error or stale")
        .choices({"starting", "ready", "running", "degraded", "fault", "stopping"})
        .add("health", &S::health, "Its health items")
        .addMaybe("restart_for", &S::restartFor, "Paths of changed settings that wait for a restart");
}

Fields<LogMessage> fieldsOf(Of<LogMessage>) {
    using L = LogMessage;
    return Fields<L>()
        .add("stamp", &L::stamp, "Since the Unix epoch", "s")
        .add("level", &L::level, "How bad it is")
        .choices({"debug", "info", "warning", "error"})
        .addMaybe("source", &L::source, "What spoke")
        .add("text", &L::text, "What it said");
}

Fields<CommandMessage> fieldsOf(Of<CommandMessage>) {
    using C = CommandMessage;
    return Fields<C>()
        .add("stamp", &C::stamp, "Since the Unix epoch; of several: of the last", "s")
        .add("client", &C::client, "Who called: its process and user, or the name in its certificate")
        .add("role", &C::role, "Its role")
        .add("method", &C::method, "The command")
        .add("params", &C::params, "Its parameters, shortened where they are long")
        .add("error", &C::error, "The code, where it was refused")
        .add("message", &C::message, "Why it was")
        .add("calls", &C::calls, "How many calls are summed up");
}

Fields<SettingsChange> fieldsOf(Of<SettingsChange>) {
    using C = SettingsChange;
    return Fields<C>()
        .add("changed", &C::changed, "Paths of the settings that have new values")
        .add("restart", &C::restart, "Of them: those that wait for a restart");
}

Fields<SavedSettings> fieldsOf(Of<SavedSettings>) {
    return Fields<SavedSettings>().add("path", &SavedSettings::path, "Of the file");
}

Fields<TopicDescription> fieldsOf(Of<TopicDescription>) {
    using T = TopicDescription;
    return Fields<T>()
        .add("name", &T::name, "As topics.subscribe takes it")
        .add("summary", &T::summary, "What it is")
        .add("schema", &T::schema, "The JSON Schema of its data")
        .add("snapshot", &T::snapshot, "It begins with the full state");
}

Fields<SubscriptionAnswer> fieldsOf(Of<SubscriptionAnswer>) {
    using S = SubscriptionAnswer;
    return Fields<S>().add("subscription", &S::subscription,
                           "For topics.unsubscribe; stands in each message");
}

} // namespace hermes
