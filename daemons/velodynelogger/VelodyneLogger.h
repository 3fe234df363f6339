#pragma once

#include "common/daemon/Daemon.h"
#include "common/daemon/PastFaults.h"
#include "common/recording/Recording.h"
#include "common/recording/ReplaySource.h"
#include "daemons/velodynelogger/LidarFeed.h"
#include "daemons/velodynelogger/LidarMessages.h"

#include <QElapsedTimer>

namespace hermes::velodynelogger {

/// hermes-velodynelogger: receives a Velodyne lidar or replays a capture, publishes the horizontal ring
/// and thinned turns of all lasers, records to pcap.
class VelodyneLogger : public Daemon {
public:
    VelodyneLogger();

protected:
    Result<void> start() override;
    void stop() override;
    void settingsChanged(const QStringList &paths) override;

private:
    using State = ReplaySource::State;

    void declareSettings();
    void declareTopics();
    void declareSourceCommands();
    void declareRecordCommands();

    LidarFeed::Options options();
    void tryLive();
    LidarFeed::Options ofSender(LidarFeed::Options options);
    LidarFeed::Options replayedOptions(const Call &call);
    Result<void> openLive();
    /// whole: what is told when all was played.
    Result<void> openPcap(const QString &name, const QStringList &paths, const Playback::Options &play,
                          const LidarFeed::Options &options, const PlayTime &begin = {},
                          const Result<void> &whole = {});
    Result<void> openRecording(const Call &call, const StoredRecording &stored);
    ReplaySource::Actions sourceActions();
    void closeSource();
    void replayEnded();
    void opened(State state, const QString &name);

    void captureTurn(const Call &call, const Reply &reply);

    void publishTurns();
    void updateClouds();
    void tick();
    LidarMessage lidarState() const;
    LidarGps gpsState() const;
    void updateHealth();
    void updateSourceHealth(const LidarFeed::Counts &counts);
    bool isOfOtherModel(const velodyne::PacketCounts &packets) const;
    QString otherModelText(const LidarFeed::Counts &counts);

    Recorder recorder_;
    Recording recording_{identity().name, settings(), health(), recorder_, Recording::Files::Several};
    LidarFeed feed_;
    ReplaySource source_{"packets", identity().name, settings(), feed_.player().playback(), sourceActions()};
    QTimer second_;
    QTimer retry_; ///< of publishing: the next turn, or what a reader had no room for
    bool cloudsWanted_ = false;
    QElapsedTimer sinceCapture_; ///< since the last capture.turn
    QString unopened_;           ///< why nothing can be received yet; empty: it can be, or is not wanted
    std::optional<Result<void>> replayEnd_; ///< the replay is at its end; what waits is yet to be published
    QElapsedTimer sincePacket_;             ///< since the last second in which one came
    QElapsedTimer sinceOther_;              ///< one of another model did; invalid before the first
    QElapsedTimer sinceGood_;               ///< one that is decoded did; invalid before the first
    QElapsedTimer sinceTick_;
    std::uint64_t packetsAtTick_ = 0, datagramsAtTick_ = 0, othersAtTick_ = 0, goodAtTick_ = 0;
    double packetRate_ = 0; ///< a second
    PastFaults faults_;
};

} // namespace hermes::velodynelogger
