#pragma once

#include "common/daemon/Daemon.h"
#include "daemons/velodynelogger/LidarFeed.h"
#include "daemons/velodynelogger/RecordFolder.h"

#include <QElapsedTimer>

namespace hermes {

/// hermes-velodynelogger: receives an HDL-32E or replays a capture, publishes the horizontal ring, records to
/// pcap.
class VelodyneLogger : public Daemon {
public:
    VelodyneLogger();

protected:
    Result<void> start() override;
    void stop() override;

private:
    /// Where packets come from.
    enum class Source { None, Live, Replay, Ended };
    static QString toText(Source source);

    void declareSettings();
    void declareTopics();
    void declareSourceCommands();
    void declareRecordCommands();

    LidarFeed::Options options();
    Result<void> openLive();
    Result<void> openPcap(const QString &path, double speed);
    Result<QJsonValue> openSource(const Call &call);
    void replayEnded(QString error);
    void opened(Source source, const QString &name, double speed);

    Result<QJsonValue> startRecording(const QString &name);
    Result<QJsonValue> stopRecording();
    QJsonObject recordStatus() const;
    void captureTurn(const Call &call, const Reply &reply);

    void publishTurns();
    void tick();
    QJsonObject lidarState();
    QJsonObject sourceState() const;
    void updateHealth();
    void updateSourceHealth(const LidarFeed::Counts &counts);
    void updateRecordHealth();

    Source source_ = Source::None;
    QString sourceName_; ///< "udp://ADDRESS:PORT" or a path
    double speed_ = 1;
    QString sourceError_;
    quint64 generation_ =
        0; ///< counts sources, so that the end of an old one is not taken for that of the new

    Recorder recorder_;
    RecordFolder folder_;
    LidarFeed feed_;
    QTimer second_;
    QTimer retry_; ///< of publishing what a reader had no room for
    QElapsedTimer sincePublished_;
    std::optional<QString> replayEnd_; ///< the replay is at its end; what waits is yet to be published
    QElapsedTimer sincePacket_;        ///< since the last second in which one came
    QElapsedTimer sinceTick_;
    std::uint64_t packetsAtTick_ = 0;
    double packetRate_ = 0; ///< a second
};

} // namespace hermes
