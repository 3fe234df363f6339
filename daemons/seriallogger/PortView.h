#pragma once

#include "common/ports/ChunkQueue.h"
#include "daemons/seriallogger/FixTracker.h"
#include "daemons/seriallogger/LineSplitter.h"
#include "daemons/seriallogger/PortSettings.h"

namespace hermes::seriallogger {

/// What is shown of the bytes of a port, live or replayed: its lines, and the fixes of a GPS receiver. Of the
/// main thread, but for the queue.
class PortView {
public:
    struct Sinks {
        std::function<void(const LineSplitter::Line &)> line;
        std::function<void(const Fix &)> fix;
    };

    explicit PortView(const PortSettings &settings)
        : kind_(settings.view)
        , fixes_(settings.checksum) {}

    /// What waits to be shown; takes nothing until open().
    ChunkQueue &queue() { return queue_; }
    const ChunkQueue &queue() const { return queue_; }
    /// Where nothing is to be shown it stays closed.
    void open();
    bool isOpen() const { return isOpen_; }
    /// Shows what waits, and what was begun.
    void close(const Sinks &sinks);

    /// Splits and decodes what came in since.
    void process(const Sinks &sinks);
    /// Of a live port, after process(): gives the fix begun if nothing came for long enough. In how many
    /// milliseconds to ask again; nothing: not before more came in.
    std::optional<int> settle(const Sinks &sinks);

    const std::optional<Fix> &lastFix() const { return lastFix_; }
    const FixTracker &fixes() const { return fixes_; }

private:
    std::function<void(const Fix &)> fixSink(const Sinks &sinks);

    const PortSettings::View kind_;
    ChunkQueue queue_{1 << 20}; // bytes; 11 s of 921,600 baud
    LineSplitter lines_;
    FixTracker fixes_;
    ChunkBatch batch_;
    std::optional<Fix> lastFix_;
    bool isOpen_ = false;
};

} // namespace hermes::seriallogger
