#include "protocol/messages/Recordings.h"

#include "protocol/wire/Fields.h"

namespace hermes {

Fields<RecordingError> fieldsOf(Of<RecordingError>) {
    using E = RecordingError;
    return Fields<E>()
        .add("code", &E::code, "As of an error reply")
        .add("message", &E::message, "For people")
        .add("data", &E::data, "As of an error reply");
}

Fields<RecordingStatus> fieldsOf(Of<RecordingStatus>) {
    using S = RecordingStatus;
    return Fields<S>()
        .add("recording", &S::recording, "One is under way")
        .add("free_bytes", &S::freeBytes, "Of the disk", "byte")
        .add("error", &S::error, "That ended it")
        .add("name", &S::name, "Of the recording")
        .add("session", &S::session, "Id that loggers have alike which recorded together")
        .add("folder", &S::folder, "Of the session")
        .add("path", &S::path, "Of the file that is being written")
        .add("start", &S::start, "Since the Unix epoch", "s")
        .add("duration_s", &S::duration_s, "So far, or of all, whatever happened to the wall clock", "s")
        .add("bytes", &S::bytes, "Of all files", "byte")
        .add("files", &S::files, "How many")
        .add("counts", &S::counts, "What was recorded, by kind")
        .add("losses", &S::losses, "What was not, by reason");
}

Fields<RecordingEntry> fieldsOf(Of<RecordingEntry>) {
    using E = RecordingEntry;
    return Fields<E>()
        .add("name", &E::name, "Of the recording")
        .add("folder", &E::folder, "Of the session")
        .add("session", &E::session, "Id that loggers have alike which recorded together")
        .add("loggers", &E::loggers, "That recorded into the folder")
        .add("start", &E::start, "Since the Unix epoch", "s")
        .add("start_mono", &E::start_mono, "The same by a clock that never jumps", "s")
        .add("boot", &E::boot, "The run of the kernel to which that belongs")
        .add("end", &E::end, "Since the Unix epoch; null: not ended", "s")
        .add("duration_s", &E::duration_s, "Whatever happened to the wall clock; absent: not ended", "s")
        .add("ended", &E::ended,
             "How: stopped, shut down (with its logger), free space, failed, cut off; null: not ended")
        .add("complete", &E::complete, "What was written is whole")
        .add("files", &E::files, "How many")
        .add("bytes", &E::bytes, "Of all files", "byte")
        .add("counts", &E::counts, "What was recorded, by kind")
        .add("losses", &E::losses, "What was not, by reason")
        .add("error", &E::error, "Why it cannot be read");
}

Fields<SourceStatus> fieldsOf(Of<SourceStatus>) {
    using S = SourceStatus;
    return Fields<S>()
        .add("state", &S::state, "What it is; ended: a replay is at its end")
        .choices({"none", "live", "replay", "ended"})
        .add("name", &S::name, "A path, or where live data come from")
        .add("speed", &S::speed, "Of a replay; 1: real time, 0: as fast as possible without loss")
        .add("loop", &S::loop, "It begins anew at its end")
        .add("loops", &S::loops, "Times it did")
        .add("paused", &S::paused, "It waits")
        .add("position_s", &S::position_s, "After its beginning", "s")
        .add("duration_s", &S::duration_s, "Of all of it; null: not known as yet", "s")
        .add("error", &S::error, "What ended it before its time");
}

} // namespace hermes
