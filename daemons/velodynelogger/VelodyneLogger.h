#pragma once

#include "common/daemon/Daemon.h"
#include "common/recording/Recording.h"
#include "daemons/velodynelogger/LidarFeed.h"
#include "daemons/velodynelogger/LidarMessage.h"
#include "daemons/velodynelogger/RecordFolder.h"

#include <QElapsedTimer>

namespace hermes {

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
    /// Where packets come from.
    enum class Source { None, Live, Replay, Ended };
    static QString toText(Source source);

    void declareSettings();
    void declareTopics();
    void declareSourceCommands();
    void declareRecordCommands();

    LidarFeed::Options options();
    LidarFeed::Options replayedOptions(const Call &call);
    Result<void> openLive();
    Result<void> openPcap(const QString &name, const QStringList &paths, const PcapPlayer::Options &play,
                          const LidarFeed::Options &options);
    Result<void> openRecording(const Call &call);
    Result<QJsonValue> openSource(const Call &call);
    void replayEnded(QString error);
    void opened(Source source, const QString &name, const PcapPlayer::Options &play);
    Result<QJsonValue> seek(double time_s);
    Result<QJsonValue> pause(bool paused);

    void captureTurn(const Call &call, const Reply &reply);

    void publishTurns();
    bool mayPublish();
    void updateClouds();
    void tick();
    LidarMessage lidarState() const;
    SourceStatus sourceState() const;
    LidarGps gpsState() const;
    void updateHealth();
    void updateSourceHealth(const LidarFeed::Counts &counts);

    Source source_ = Source::None;
    QString sourceName_;       ///< "udp://ADDRESS:PORT" or a path
    PcapPlayer::Options play_; ///< of a replay
    QString sourceError_;
    quint64 generation_ =
        0; ///< counts sources, so that the end of an old one is not taken for that of the new

    Recorder recorder_;
    Recording recording_{identity().name, settings(), health(), recorder_};
    RecordFolder folder_;
    LidarFeed feed_;
    QTimer second_;
    QTimer retry_; ///< of publishing: the next turn, or what a reader had no room for
    QElapsedTimer sincePublished_;
    bool cloudsWanted_ = false;
    QElapsedTimer sinceCapture_;       ///< since the last capture.turn
    std::optional<QString> replayEnd_; ///< the replay is at its end; what waits is yet to be published
    QElapsedTimer sincePacket_;        ///< since the last second in which one came
    QElapsedTimer sinceTick_;
    std::uint64_t packetsAtTick_ = 0, datagramsAtTick_ = 0;
    double packetRate_ = 0; ///< a second
};

} // namespace hermes
