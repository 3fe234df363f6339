#pragma once

#include "common/daemon/Daemon.h"
#include "common/daemon/PastFaults.h"
#include "common/ports/SerialPlayer.h"
#include "common/ports/SerialRecorder.h"
#include "common/recording/Recording.h"
#include "common/recording/ReplaySource.h"
#include "daemons/scanner/LiveScanner.h"
#include "daemons/scanner/ScannerMessages.h"

namespace hermes::scanner {

/// hermes-scanner: reads a laser scanner of one plane on a serial line or over TCP, or replays a recording of
/// one, publishes each revolution, records its bytes.
class Scanner : public Daemon {
public:
    Scanner();

protected:
    Result<void> start() override;
    void stop() override;

private:
    void declareSettings();
    void declareTopics();
    void declareCommands();

    ReplaySource::Actions sourceActions();
    void openLive();
    Result<void> openRecording(const Call &call, const StoredRecording &stored);
    ChunkQueue *replayedQueue(const QString &port, const QJsonObject &sidecar);
    void processReplay();
    void publishScan(const scan::Revolution &revolution, bool replayed);

    /// For the sidecar of recordings.
    void noteScanner();
    void tick();
    const ScanReader &shown() const { return replayed_ ? *replayed_ : live_->reader(); }
    ScannerMessage state() const;
    void updateHealth();
    std::pair<HealthLevel, QString> sensorHealth();

    ChunkQueue recordingQueue_{1 << 22}; // bytes; 40 s of 1,000,000 baud
    SerialRecorder recorder_;
    Recording recording_{identity().name, settings(), health(), recorder_};
    std::unique_ptr<LiveScanner> live_;
    std::unique_ptr<ScanReader> replayed_; ///< outlives the player's use of its queue
    SerialPlayer player_;
    ReplaySource source_{"revolutions", identity().name, settings(), player_.playback(), sourceActions()};
    QTimer second_;
    QTimer retry_;                          ///< of publishing what is replayed, when readers had no room
    std::optional<Result<void>> replayEnd_; ///< it is at its end; what waits is yet to be published
    PastFaults faults_;
    mutable std::mutex mutex_; // guards what follows, which the recorder asks for
    QJsonObject prerequisite_; ///< {model, prerequisite} of what is read live
};

} // namespace hermes::scanner
