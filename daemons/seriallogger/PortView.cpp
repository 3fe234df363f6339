#include "daemons/seriallogger/PortView.h"

namespace hermes {

void PortView::open() {
    if (kind_ != PortSettings::View::None)
        queue_.open();
}

void PortView::close(const Sinks &sinks) {
    queue_.close();
    process(sinks);
    lines_.finish(sinks.line);
    fixes_.finish(sinks.fix);
    fixes_.skip();
}

void PortView::process(const Sinks &sinks) {
    const auto fixSink = [this, &sinks](const Fix &fix) {
        lastFix_ = fix;
        sinks.fix(fix);
    };
    queue_.take(batch_);
    const char *next = batch_.bytes.data();
    for (const ChunkBatch::Chunk &chunk : batch_.chunks) {
        if (chunk.lostBefore > 0) {
            lines_.skip(chunk.lostBefore, sinks.line);
            fixes_.skip();
        }
        const std::string_view bytes(next, chunk.size);
        lines_.feed(bytes, chunk.arrival, sinks.line);
        if (kind_ == PortSettings::View::Nmea)
            fixes_.feed(bytes, chunk.arrival, fixSink);
        next += chunk.size;
    }
}

} // namespace hermes
