#include "daemons/seriallogger/SerialMessages.h"

#include "protocol/wire/Fields.h"

namespace hermes::seriallogger {

FixValues valuesOf(const Fix &fix) {
    FixValues values{
        fix.arrival.stamp(), fix.arrival.mono(), fix.time,       fix.valid, {},        {},
        fix.altitude,        fix.quality,        fix.satellites, fix.hdop,  fix.speed, fix.course_deg};
    if (fix.position) {
        values.lat_deg = fix.position->latitude_deg;
        values.lon_deg = fix.position->longitude_deg;
    }
    return values;
}

Fields<LineMessage> fieldsOf(Of<LineMessage>) {
    using L = LineMessage;
    return Fields<L>()
        .add("port", &L::port, "That it came from")
        .add("stamp", &L::stamp, "Of its first byte, since the Unix epoch", "s")
        .add("mono", &L::mono, "The stamp on a clock that never jumps", "s")
        .add("text", &L::text, "Printable ASCII; \\\\ and \\xHH for the rest")
        .add("cut", &L::cut, "More of the line follows");
}

Fields<NmeaCounts> fieldsOf(Of<NmeaCounts>) {
    using N = NmeaCounts;
    return Fields<N>()
        .add("sentences", &N::sentences, "Whole ones")
        .add("bad_checksum", &N::badChecksum, "Damaged sentences")
        .add("no_checksum", &N::noChecksum, "Sentences refused, as they have none")
        .add("too_long", &N::tooLong, "Sentences")
        .add("bad_byte", &N::badByte, "Sentences with a byte that cannot be")
        .add("cut_short", &N::cutShort, "Sentences without their end")
        .add("skipped_bytes", &N::skippedBytes, "Between sentences", "byte")
        .add("bad_fields", &N::badFields, "Sentences whose fields make no sense")
        .add("repeated", &N::repeated, "Sentences that came again")
        .add("late", &N::late, "Sentences that came after their fix was given")
        .add("last_fault", &N::lastFault, "Of the fields");
}

Fields<PortStatus> fieldsOf(Of<PortStatus>) {
    using P = PortStatus;
    return Fields<P>()
        .add("name", &P::name, "As of the setting ports")
        .add("url", &P::url, "As of the setting ports")
        .add("state", &P::state, "Of its device")
        .choices({"open", "opening", "closed"})
        .add("reason", &P::reason, "Why it is closed")
        .add("device", &P::device, "That a link led to as it was opened")
        .add("opened", &P::opened, "Times")
        .add("failures", &P::failures, "To open it, and ends")
        .add("bytes", &P::bytes, "Received", "byte")
        .add("bytes_per_s", &P::bytesPerSecond, "Received in the last second", "byte/s")
        .add("sent", &P::sent, "To the device", "byte")
        .add("lost", &P::lost, "That the disk was too slow for", "byte")
        .add("view_lost", &P::viewLost, "That were recorded, but not shown", "byte")
        .add("system_errors", &P::systemErrors, "Counts that the system tells of, by kind")
        .addOrNull("last_stamp", &P::lastStamp, "Of the last bytes, since the Unix epoch", "s")
        .add("nmea", &P::nmea, "Of a port with view nmea: what was found")
        .add("fix", &P::fix, "Of a port with view nmea: the last one");
}

Fields<SerialMessage> fieldsOf(Of<SerialMessage>) {
    using S = SerialMessage;
    return Fields<S>()
        .add("ports", &S::ports, "As ports.list gives them")
        .add("recording", &S::recording, "They are recorded")
        .add("source", &S::source, "Where lines and fixes come from");
}

Fields<MarkAnswer> fieldsOf(Of<MarkAnswer>) {
    using M = MarkAnswer;
    return Fields<M>()
        .add("stamp", &M::stamp, "Since the Unix epoch", "s")
        .add("mono", &M::mono, "The stamp on a clock that never jumps", "s");
}

Fields<RecordedMark> fieldsOf(Of<RecordedMark>) {
    using M = RecordedMark;
    return Fields<M>()
        .add("t_s", &M::t_s, "After the beginning, by a clock that never jumps", "s")
        .add("stamp", &M::stamp, "Since the Unix epoch", "s")
        .add("text", &M::text, "What mark was given");
}

Fields<SendAnswer> fieldsOf(Of<SendAnswer>) {
    return Fields<SendAnswer>().add("sent", &SendAnswer::sent, "Bytes", "byte");
}

Fields<ExportAnswer> fieldsOf(Of<ExportAnswer>) {
    return Fields<ExportAnswer>()
        .add("path", &ExportAnswer::path, "Of the CSV")
        .add("rows", &ExportAnswer::rows, "Without the header");
}

} // namespace hermes::seriallogger
