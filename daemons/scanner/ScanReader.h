#pragma once

#include "common/ports/ChunkQueue.h"
#include "protocol/messages/Turns.h"
#include "protocol/scan/ScannerModel.h"

namespace hermes::scanner {

/// A scanner's bytes on their way from a queue to revolutions.
class ScanReader {
public:
    ScanReader(const scan::ScannerModel &model, scan::RevolutionAssembler::Sink sink);

    ChunkQueue &queue() { return queue_; }
    const ChunkQueue &queue() const { return queue_; }
    /// Takes what waits in the queue, as long as that may go on. False: not all of it.
    bool process(const std::function<bool()> &mayGoOn = [] { return true; });
    /// Gives what there is of the revolution under way.
    void finish() { revolutions_.jump(); }

    const scan::ScannerModel &model() const { return model_; }
    scan::ScannerProtocol &protocol() { return *protocol_; }
    const scan::ScannerProtocol &protocol() const { return *protocol_; }
    scan::RevolutionAssembler::Counts counts() const { return revolutions_.counts(); }
    quint64 beams() const { return beams_; } ///< of the last whole revolution
    /// From one revolution to the next; 0: not known.
    double period_s() const { return double(revolutions_.period_ns()) * 1e-9; }
    std::int64_t clockBound_ns() const { return clockBound_ns_; }
    /// When the last revolution was given, by a clock that never jumps; 0: none was.
    double lastMono() const { return lastMono_; }

private:
    void take(const scan::Revolution &revolution);

    const scan::ScannerModel &model_;
    const scan::RevolutionAssembler::Sink sink_;
    ChunkQueue queue_{1 << 20}; // bytes; 10 s of 1,000,000 baud
    ChunkBatch batch_;
    std::size_t nextChunk_ = 0, nextByte_ = 0; ///< of the batch
    scan::RevolutionAssembler revolutions_;
    std::unique_ptr<scan::ScannerProtocol> protocol_;
    quint64 beams_ = 0;
    double lastMono_ = 0;
    std::int64_t clockBound_ns_ = 0;
};

/// Without the beams that did not come back; replayed: it was recorded.
ScanMessage toScanMessage(const scan::Revolution &revolution, bool replayed);

} // namespace hermes::scanner
