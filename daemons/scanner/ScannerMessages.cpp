#include "daemons/scanner/ScannerMessages.h"

#include "protocol/wire/Fields.h"

namespace hermes::scanner {

Fields<ScannerMessage> fieldsOf(Of<ScannerMessage>) {
    using S = ScannerMessage;
    return Fields<S>()
        .add("source", &S::source, "Where scans come from; what is counted here, is since it was opened")
        .addOrNull("model", &S::model,
                   "As the setting scanner.model names it; null: it is looked for, or it may be any of some "
                   "that speak "
                   "alike")
        .addOrNull("device", &S::device, "As the scanner names itself")
        .addOrNull("firmware", &S::firmware, "Its version")
        .addOrNull("serial", &S::serial, "Its number")
        .add("url", &S::url, "Of the line")
        .add("line", &S::line, "Whether that is open")
        .choices({"open", "opening", "closed"})
        .add("rpm", &S::rpm, "Revolutions a minute, of the last whole ones", "1/min")
        .add("beams", &S::beams, "In the last whole revolution")
        .add("revolutions", &S::revolutions, "Whole ones")
        .add("partial", &S::partial, "Those of which something is missing")
        .add("missed", &S::missed,
             "Revolutions for which there was time, and of which nothing came; an estimate by how long one "
             "takes")
        .add("packets", &S::packets, "With measurements")
        .add("damaged", &S::damaged, "Packets, by their checksums or by what stands in them")
        .add("lost", &S::lost, "Packets that are missing, the damaged ones among them")
        .add("skipped_bytes", &S::skippedBytes, "That belong to no packet", "byte")
        .add("bytes", &S::bytes, "That came in", "byte")
        .add("unread_bytes", &S::unreadBytes, "Recorded, but too many at once to decode", "byte")
        .add("recording", &S::recording, "As record.status gives it");
}

} // namespace hermes::scanner
