#include "protocol/messages/Sessions.h"

#include "protocol/wire/Fields.h"

namespace hermes {

const Fields<SessionPart> &fieldsOf(Of<SessionPart>) {
    using P = SessionPart;
    static const auto fields =
        Fields<P>()
            .add("daemon", &P::daemon, "Its name; with @HOST:PORT where several daemons have it")
            .add("state", &P::state, "What it does with the session; silent: it does not answer")
            .choices({"recording", "stopped", "cut off", "failed", "free space", "silent"})
            .add("bytes", &P::bytes, "Of its files", "byte")
            .add("counts", &P::counts, "What was recorded, by kind")
            .add("losses", &P::losses, "What was not, by reason")
            .add("problem", &P::problem, "Why something is missing; empty: nothing is");
    return fields;
}

const Fields<SessionMark> &fieldsOf(Of<SessionMark>) {
    using M = SessionMark;
    static const auto fields = Fields<M>()
                                   .add("t_s", &M::t_s, "After the beginning of the session", "s")
                                   .add("text", &M::text, "What somebody put in");
    return fields;
}

const Fields<SessionReplay> &fieldsOf(Of<SessionReplay>) {
    using R = SessionReplay;
    static const auto fields =
        Fields<R>()
            .add("position_s", &R::position_s, "After the beginning of the session", "s")
            .add("duration_s", &R::duration_s, "Of all of it; 0: not known yet", "s")
            .add("speed", &R::speed, "1: real time")
            .add("paused", &R::paused, "It waits")
            .add("loop", &R::loop, "It begins anew at its end");
    return fields;
}

const Fields<SessionState> &fieldsOf(Of<SessionState>) {
    using S = SessionState;
    static const auto fields =
        Fields<S>()
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
    return fields;
}

const Fields<SessionSummary> &fieldsOf(Of<SessionSummary>) {
    using S = SessionSummary;
    static const auto fields = Fields<S>()
                                   .add("name", &S::name, "Of its folder")
                                   .add("session", &S::session, "Its id, which all parts have alike")
                                   .add("start", &S::start, "Since the Unix epoch", "s")
                                   .add("end", &S::end, "Since the Unix epoch; absent: it goes on", "s")
                                   .add("bytes", &S::bytes, "Of all parts", "byte")
                                   .add("daemons", &S::daemons, "That have a part of it")
                                   .add("problems", &S::problems, "What is missing, a line each");
    return fields;
}

const Fields<SessionTopic> &fieldsOf(Of<SessionTopic>) {
    using T = SessionTopic;
    static const auto fields = Fields<T>()
                                   .add("topic", &T::topic, "As in the files: DAEMON/TOPIC")
                                   .add("messages", &T::messages, "Recorded")
                                   .add("lost", &T::lost, "Not recorded, as far as it is known")
                                   .add("rate_hz", &T::rate_hz, "The mean", "Hz")
                                   .add("longest_gap_s", &T::longest_gap_s, "Between two messages", "s");
    return fields;
}

const Fields<SessionInfo> &fieldsOf(Of<SessionInfo>) {
    using I = SessionInfo;
    static const auto fields =
        Fields<I>()
            .add("summary", &I::summary, "As session.list gives it")
            .add("duration_s", &I::duration_s, "From the first message to the last", "s")
            .add("driven_m", &I::driven_m, "The way, by odometry; absent: there is none", "m")
            .add("parts", &I::parts, "Of each daemon that recorded it")
            .add("topics", &I::topics, "Of the recorder's files")
            .add("marks", &I::marks, "In the order of their times")
            .add("stops", &I::stops, "Each stop that somebody commanded: when, what, who")
            .add("faults", &I::faults, "Each health item that got to error: when, where, what");
    return fields;
}

const Fields<SessionText> &fieldsOf(Of<SessionText>) {
    static const auto fields = Fields<SessionText>().add("text", &SessionText::text, "A page for people");
    return fields;
}

const Fields<SessionFiles> &fieldsOf(Of<SessionFiles>) {
    static const auto fields = Fields<SessionFiles>().add("paths", &SessionFiles::paths, "Written");
    return fields;
}

} // namespace hermes
