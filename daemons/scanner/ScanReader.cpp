#include "daemons/scanner/ScanReader.h"

#include <QtMath>

#include <algorithm>
#include <cmath>

namespace hermes::scanner {

/// Whatever the index of a recording says.
static std::int64_t bounded(std::int64_t time_ns) {
    constexpr std::int64_t latest_ns = std::int64_t(1) << 61;
    return std::clamp<std::int64_t>(time_ns, 0, latest_ns);
}

ScanReader::ScanReader(const scan::ScannerModel &model, scan::RevolutionAssembler::Sink sink)
    : model_(model)
    , sink_(std::move(sink))
    , revolutions_([this](const scan::Revolution &revolution) { take(revolution); })
    , protocol_(model.make(model, revolutions_)) {}

bool ScanReader::process(const std::function<bool()> &mayGoOn) {
    for (;;) {
        if (nextChunk_ == batch_.chunks.size()) {
            queue_.take(batch_);
            nextChunk_ = nextByte_ = 0;
            if (batch_.chunks.empty())
                return true;
        }
        for (; nextChunk_ < batch_.chunks.size(); ++nextChunk_) {
            if (!mayGoOn())
                return false;
            const ChunkBatch::Chunk &chunk = batch_.chunks[nextChunk_];
            if (chunk.lostBefore > 0 || chunk.isJump)
                protocol_->jump();
            if (chunk.isJump)
                revolutions_.seek();
            protocol_->feed({batch_.bytes.data() + nextByte_, chunk.size},
                            {bounded(chunk.arrival.stamp_ns), bounded(chunk.arrival.mono_ns)});
            nextByte_ += chunk.size;
        }
    }
}

void ScanReader::take(const scan::Revolution &revolution) {
    lastMono_ = monotonicNow();
    clockBound_ns_ = revolution.clockBound_ns;
    if (!revolution.partial)
        beams_ = revolution.beams.size();
    sink_(revolution);
}

/// In a full revolution, of which a sweep is a part.
static quint64 raysOf(const scan::Revolution &revolution) {
    double span_deg = 0;
    for (std::size_t i = 1; i < revolution.beams.size(); ++i)
        span_deg +=
            std::abs(std::remainder(revolution.beams[i].angle_deg - revolution.beams[i - 1].angle_deg, 360));
    const double beams = double(revolution.beams.size());
    return span_deg > 1 && beams > 1 ? quint64(std::lround((beams - 1) * 360 / span_deg)) : quint64(beams);
}

ScanMessage toScanMessage(const scan::Revolution &revolution, bool replayed) {
    ScanMessage message;
    message.header.turn = revolution.number;
    message.header.stamp = double(revolution.begin_ns) * 1e-9;
    message.header.duration_s = double(revolution.end_ns - revolution.begin_ns) * 1e-9;
    message.header.partial = revolution.partial;
    message.header.rays = raysOf(revolution);
    message.header.lostPackets = revolution.lostPackets;
    message.header.frame = "scanner";
    message.header.replayed = replayed;
    message.header.clock = "host";
    message.header.clockError_s = double(revolution.clockBound_ns) * 1e-9;
    std::vector<float> &t = message.t.emplace();
    for (std::vector<float> *values : {&message.x, &message.y, &t})
        values->reserve(revolution.beams.size());
    message.intensity.reserve(revolution.beams.size());
    for (const scan::Beam &beam : revolution.beams) {
        if (beam.range_m <= 0)
            continue;
        const double angle = qDegreesToRadians(beam.angle_deg);
        message.x.push_back(float(beam.range_m * std::cos(angle)));
        message.y.push_back(float(beam.range_m * std::sin(angle)));
        t.push_back(float(double(beam.stamp_ns - revolution.begin_ns) * 1e-9));
        message.intensity.push_back(beam.intensity);
    }
    return message;
}

} // namespace hermes::scanner
