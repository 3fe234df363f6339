#pragma once

#include "common/ports/ChunkQueue.h"
#include "common/ports/SerialLogReader.h"
#include "common/recording/ReplaySource.h"

#include <functional>
#include <memory>

namespace hermes {

/// Plays the bytes of a recording into a queue of each port, in a thread of its own, at the pace at which
/// they came in or any other. Loses nothing: waits where a queue has no room.
class SerialPlayer {
public:
    /// The open queue for the bytes of a port, which stays until stop() or the next start(); null: the port
    /// is left out. Called by start(), for each port.
    using QueueOf = std::function<ChunkQueue *(const QString &port, const QJsonObject &sidecar)>;
    /// Called in the playing thread: a queue was filled; all has been played, or an error ended it.
    using Filled = std::function<void()>;
    using End = std::function<void(const Result<void> &result)>;

    ~SerialPlayer() { stop(); }

    /// Nothing is played when it fails. delay_s: the time of the replay at which the recording begins.
    Result<void> start(const StoredRecording &recording, const Playback::Options &options, double delay_s,
                       const QueueOf &queueOf, Filled filled, End end);
    void stop();
    Playback &playback() { return playback_; }
    /// Of a logger that plays its recordings by this one.
    ReplaySource::Actions actions(const std::function<void()> &live,
                                  decltype(ReplaySource::Actions::recording) recording,
                                  std::function<void()> changed) const;
    double duration_s() const { return delay_s_ + length_s_; }

private:
    /// One port of the recording.
    struct Track {
        ChunkQueue *queue;
        SerialLogReader reader;
        SerialLogReader::Piece piece; ///< the next one to be played; no bytes: at its end
        std::int64_t time_ns = 0;     ///< of the replay, of that piece
    };

    Result<void> addTrack(const QString &path, ChunkQueue *queue);
    Result<void> advance(Track &track);
    Track *nextTrack() const;
    void run();
    Playback::Turn wait(const Track &track);
    Result<void> play(Track &track);
    Result<void> goTo(std::int64_t time_ns);

    double delay_s_ = 0;
    double startMono_s_ = 0;
    double length_s_ = 0;
    std::vector<std::unique_ptr<Track>> tracks_;
    Filled filled_;
    End end_;
    Result<void> missing_; // what a file had when it was recorded, and has no more
    Playback playback_;
};

} // namespace hermes
