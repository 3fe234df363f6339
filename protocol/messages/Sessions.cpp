#include "protocol/messages/Sessions.h"

#include "protocol/wire/Fields.h"

namespace hermes {

Fields<SessionPart> fieldsOf(Of<SessionPart>) {
    using P = SessionPart;
    return Fields<P>()
        .add("daemon", &P::daemon, "Its name; with @HOST:PORT where several daemons have it")
        .add("state", &P::state, "What it does with the session; silent: it does not answer")
        .choices({"recording", "stopped", "shut down", "cut off", "failed", "free space", "silent"})
        .add("bytes", &P::bytes, "Of its files", "byte")
        .add("counts", &P::counts, "What was recorded, by kind")
        .add("losses", &P::losses, "What was not, by reason")
        .add("problem", &P::problem, "Why something is missing; empty: nothing is");
}

Fields<SessionMark> fieldsOf(Of<SessionMark>) {
    using M = SessionMark;
    return Fields<M>()
        .add("t_s", &M::t_s, "After the beginning of the session", "s")
        .add("text", &M::text, "What somebody put in");
}

Fields<SessionReplay> fieldsOf(Of<SessionReplay>) {
    using R = SessionReplay;
    return Fields<R>()
        .add("position_s", &R::position_s, "After the beginning of the session", "s")
        .add("duration_s", &R::duration_s, "Of all of it; 0: not known yet", "s")
        .add("speed", &R::speed, "1: real time")
        .add("paused", &R::paused, "It waits")
        .add("loop", &R::loop, "It begins anew at its end");
}

Fields<SessionState> fieldsOf(Of<SessionState>) {
    using S = SessionState;
    return Fields<S>()
        .add("state", &S::state, "What the recorder does")
        .choices({"idle", "starting", "recording", "stopping", "replaying"})
        .add("name", &S::name, "Of what is recorded or replayed, or was last; empty: nothing yet")
        .add("session", &S::session, "Its id, which all parts have alike")
        .add("start", &S::start, "Since the Unix epoch", "s")
        .add("duration_s", &S::duration_s, "Recorded so far", "s")
        .add("bytes", &S::bytes, "Of all parts", "byte")
        .add("free_bytes", &S::free_bytes, "Of the fullest disk", "byte")
        .add("left_s", &S::left_s, "Until that disk is full, at the rate of the last ten seconds", "s")
        .add("parts", &S::parts, "Of each daemon that records, or recorded, it")
        .add("marks", &S::marks, "In the order of their times")
        .add("problems", &S::problems, "What is wrong with it, a line each")
        .add("notes", &S::notes, "What was not well with those that record it, as it began")
        .add("silent", &S::silent, "Daemons of the robot that do not answer")
        .add("replay", &S::replay, "While it is replayed");
}

Fields<SessionSummary> fieldsOf(Of<SessionSummary>) {
    using S = SessionSummary;
    return Fields<S>()
        .add("name", &S::name, "Of its folder")
        .add("session", &S::session, "Its id, which all parts have alike")
        .add("start", &S::start, "Since the Unix epoch", "s")
        .add("end", &S::end, "Since the Unix epoch; absent: it goes on", "s")
        .add("duration_s", &S::duration_s, "Whatever happened to the wall clock; absent: it goes on", "s")
        .add("bytes", &S::bytes, "Of all parts", "byte")
        .add("daemons", &S::daemons, "That have a part of it")
        .add("problems", &S::problems, "What is missing, a line each");
}

Fields<SessionTopic> fieldsOf(Of<SessionTopic>) {
    using T = SessionTopic;
    return Fields<T>()
        .add("topic", &T::topic, "As in the files: DAEMON/TOPIC")
        .add("messages", &T::messages, "Recorded")
        .add("lost", &T::lost, "Not recorded, as far as it is known")
        .add("rate_hz", &T::rate_hz, "The mean", "Hz")
        .add("longest_gap_s", &T::longest_gap_s, "Between two messages", "s");
}

Fields<SessionInfo> fieldsOf(Of<SessionInfo>) {
    using I = SessionInfo;
    return Fields<I>()
        .add("summary", &I::summary, "As session.list gives it")
        .add("duration_s", &I::duration_s, "As in summary; of one that goes on: to the last message", "s")
        .add("driven_m", &I::driven_m, "The way, by odometry; absent: there is none", "m")
        .add("parts", &I::parts, "Of each daemon that recorded it")
        .add("topics", &I::topics, "Of the recorder's files")
        .add("marks", &I::marks, "In the order of their times")
        .add("stops", &I::stops, "Each stop that somebody commanded: when, what, who")
        .add("faults", &I::faults, "Each health item that got to error: when, where, what");
}

Fields<SessionText> fieldsOf(Of<SessionText>) {
    return Fields<SessionText>().add("text", &SessionText::text, "A page for people");
}

Fields<SessionFiles> fieldsOf(Of<SessionFiles>) {
    return Fields<SessionFiles>()
        .add("paths", &SessionFiles::paths, "Written")
        .add("problems", &SessionFiles::problems, "What of the session is missing in them, a line each");
}

} // namespace hermes
