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

    Source m_source = Source::None;
    QString m_sourceName; ///< "udp://ADDRESS:PORT" or a path
    double m_speed = 1;
    QString m_sourceError;
    quint64 m_generation =
        0; ///< counts sources, so that the end of an old one is not taken for that of the new

    Recorder m_recorder;
    RecordFolder m_folder;
    LidarFeed m_feed;
    QTimer m_second;
    QTimer m_retry; ///< of publishing what a reader had no room for
    QElapsedTimer m_sincePublished;
    std::optional<QString> m_replayEnd; ///< the replay is at its end; what waits is yet to be published
    QElapsedTimer m_sincePacket;        ///< since the last second in which one came
    QElapsedTimer m_sinceTick;
    std::uint64_t m_packetsAtTick = 0;
    double m_packetRate = 0; ///< a second
};

} // namespace hermes
