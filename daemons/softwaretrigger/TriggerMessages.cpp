#include "daemons/softwaretrigger/TriggerMessages.h"

#include "daemons/softwaretrigger/Definition.h"
#include "protocol/wire/Fields.h"

namespace hermes::softwaretrigger {

Fields<FiringCause> fieldsOf(Of<FiringCause>) {
    using C = FiringCause;
    return Fields<C>()
        .add("kind", &C::kind, "That of the trigger, or command: trigger.fire")
        .choices(causeKinds())
        .add("n", &C::n, "period, distance, angle: which, from 1")
        .add("due_mono", &C::dueMono, "period: the time it fires for, on a clock that never jumps", "s")
        .add("due", &C::due, "time_of_day: the time it fires for, since the Unix epoch", "s")
        .add("travelled", &C::travelled, "distance (m), angle (rad): in all")
        .add("pose", &C::pose, "distance, angle: by the odometry")
        .add("value", &C::value, "condition: what stands at its path")
        .add("trigger", &C::trigger, "trigger: whose firing it follows")
        .add("trigger_seq", &C::triggerSeq, "trigger: which firing of that")
        .add("client", &C::client, "command: who fired it");
}

Fields<ActionOutcome::Failure> fieldsOf(Of<ActionOutcome::Failure>) {
    using F = ActionOutcome::Failure;
    return Fields<F>()
        .add("code", &F::code, "Of the error")
        .add("message", &F::message, "What was done, found, expected");
}

Fields<ActionOutcome> fieldsOf(Of<ActionOutcome>) {
    using O = ActionOutcome;
    return Fields<O>()
        .add("action", &O::action, "What it is")
        .add("ok", &O::ok, "It did not fail")
        .add("duration_s", &O::duration_s, "From its begin to its end", "s")
        .add("error", &O::error, "Why it failed")
        .add("result", &O::result, "What a call gave, unless that is long");
}

Fields<FiringMessage> fieldsOf(Of<FiringMessage>) {
    using F = FiringMessage;
    return Fields<F>()
        .add("id", &F::id, "Of the trigger")
        .add("seq", &F::seq, "Counts its firings")
        .add("stamp", &F::stamp, "When its actions began, since the Unix epoch", "s")
        .add("mono", &F::mono, "The same on a clock that never jumps", "s")
        .add("jitter_s", &F::jitter_s, "How long that was after the time that it fires for", "s")
        .add("missed", &F::missed, "Firings since the one before that did not happen")
        .add("cause", &F::cause, "Why it fired")
        .add("ok", &F::ok, "No action failed")
        .add("results", &F::results, "Of each action");
}

Fields<Jitter> fieldsOf(Of<Jitter>) {
    return Fields<Jitter>()
        .add("count", &Jitter::count, "Firings that it is of, the last 1000 at most")
        .add("mean_s", &Jitter::mean_s, "Mean", "s")
        .add("p99_s", &Jitter::p99_s, "99 of 100 are not later", "s")
        .add("worst_s", &Jitter::worst_s, "The latest", "s");
}

Fields<FiringLog::State> fieldsOf(Of<FiringLog::State>) {
    using S = FiringLog::State;
    return Fields<S>()
        .add("folder", &S::folder, "Of the log, or empty")
        .add("path", &S::path, "Of its last file")
        .add("rows", &S::rows, "Written")
        .add("lost", &S::lost, "Rows that could not be written")
        .add("error", &S::error, "Why the last row was not written, or empty");
}

Fields<WatchedState> fieldsOf(Of<WatchedState>) {
    using W = WatchedState;
    return Fields<W>()
        .add("messages", &W::messages, "Of the topic")
        .add("bad_messages", &W::badMessages, "That could not be used")
        .add("travelled", &W::travelled, "distance (m), angle (rad): in all")
        .add("jumps", &W::jumps, "Poses that the speed does not explain");
}

Fields<TriggerState> fieldsOf(Of<TriggerState>) {
    using S = TriggerState;
    return Fields<S>()
        .add("armed", &S::armed, "It fires")
        .add("fired", &S::fired, "Firings")
        .add("missed", &S::missed, "Firings that did not happen")
        .add("failed_actions", &S::failedActions, "Of all firings")
        .add("jitter", &S::jitter, "How late the last firings were")
        .addOrNull("last", &S::last, "Firing, as in the topic fired")
        .add("problem", &S::problem, "Why it cannot watch, or empty")
        .add("watched", &S::watched, "What it has seen of its topic");
}

} // namespace hermes::softwaretrigger
