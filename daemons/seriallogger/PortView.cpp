#include "daemons/seriallogger/PortView.h"

namespace hermes::seriallogger {

void PortView::open() {
    isOpen_ = kind_ != PortSettings::View::None;
    if (isOpen_)
        queue_.open();
}

void PortView::close(const Sinks &sinks) {
    isOpen_ = false;
    queue_.close();
    process(sinks);
    lines_.finish(sinks.line);
    fixes_.pause(fixSink(sinks));
    fixes_.skip();
}

std::function<void(const Fix &)> PortView::fixSink(const Sinks &sinks) {
    return [this, &sinks](const Fix &fix) {
        lastFix_ = fix;
        sinks.fix(fix);
    };
}

std::optional<int> PortView::settle(const Sinks &sinks) {
    const std::optional<std::int64_t> until_ns = fixes_.waitUntilMono_ns();
    if (!until_ns)
        return std::nullopt;
    const std::int64_t left_ns = *until_ns - Moment::now().mono_ns;
    if (left_ns > 0)
        return int(left_ns / 1000000) + 1;
    fixes_.pause(fixSink(sinks));
    return std::nullopt;
}

void PortView::process(const Sinks &sinks) {
    queue_.take(batch_);
    const char *next = batch_.bytes.data();
    for (const ChunkBatch::Chunk &chunk : batch_.chunks) {
        if (chunk.lostBefore > 0) {
            lines_.skip(chunk.lostBefore, sinks.line);
            fixes_.skip();
        }
        if (chunk.isJump) {
            lines_.skip(0, sinks.line);
            fixes_.pause(fixSink(sinks));
            fixes_.skip();
        }
        const std::string_view bytes(next, chunk.size);
        lines_.feed(bytes, chunk.arrival, sinks.line);
        if (kind_ == PortSettings::View::Nmea)
            fixes_.feed(bytes, chunk.arrival, fixSink(sinks));
        next += chunk.size;
    }
}

} // namespace hermes::seriallogger
