// What the Velodyne logger tells about itself: the topic lidar, status of source and recording, health.
#include "daemons/velodynelogger/VelodyneLogger.h"

namespace hermes {

QString VelodyneLogger::toText(Source source) {
    switch (source) {
    case Source::None:
        return "none";
    case Source::Live:
        return "live";
    case Source::Replay:
        return "replay";
    case Source::Ended:
        return "ended";
    }
    return {};
}

QJsonObject VelodyneLogger::sourceState() const {
    QJsonObject state{{"state", toText(source_)}, {"name", sourceName_}, {"speed", speed_}};
    if (!sourceError_.isEmpty())
        state.insert("error", sourceError_);
    return state;
}

QJsonObject VelodyneLogger::lidarState() {
    const LidarFeed::Counts counts = feed_.counts();
    const velodyne::PacketCounts &packets = counts.packets;
    return {{"source", sourceState()},
            {"rpm", counts.rpm},
            {"packet_rate_hz", packetRate_},
            {"packets", double(packets.packets)},
            {"turns", double(counts.turns)},
            {"lost", double(packets.lost)},
            {"gaps", double(packets.gaps)},
            {"out_of_order", double(packets.outOfOrder)},
            {"clock_jumps", double(packets.clockJumps)},
            {"wrong_size", double(packets.wrongSize)},
            {"wrong_flag", double(packets.wrongFlag)},
            {"wrong_value", double(packets.wrongValue)},
            {"other_model", double(packets.otherModel)},
            {"position_packets", double(counts.position)},
            {"other_datagrams", double(counts.other + counts.udp.tooLong)},
            {"kernel_drops", double(counts.udp.kernelDrops)},
            {"turns_dropped", double(counts.turnsDropped)},
            {"recording", recordStatus()}};
}

QJsonObject VelodyneLogger::recordStatus() const {
    const Recorder::Status status = recorder_.status();
    QJsonObject state{{"recording", status.recording},
                      {"path", QString::fromStdString(status.path)},
                      {"packets", double(status.packets)},
                      {"bytes", double(status.bytes)},
                      {"dropped", double(status.dropped)}};
    if (!status.error.empty()) {
        const Error error =
            diskError(QString::fromStdString(status.error), QString::fromStdString(status.path));
        state.insert("error",
                     QJsonObject{{"code", error.code}, {"message", error.message}, {"data", error.data}});
    }
    return state;
}

void VelodyneLogger::updateHealth() {
    updateSourceHealth(feed_.counts());
    updateRecordHealth();
}

void VelodyneLogger::updateSourceHealth(const LidarFeed::Counts &counts) {
    const velodyne::PacketCounts &packets = counts.packets;
    const std::uint64_t wrong =
        packets.wrongSize + packets.wrongFlag + packets.wrongValue + packets.otherModel;
    const std::uint64_t lost =
        packets.lost + packets.outOfOrder + counts.udp.kernelDrops + counts.turnsDropped;
    const QJsonObject values{{"packets", double(packets.packets)},
                             {"packet_rate_hz", packetRate_},
                             {"rpm", counts.rpm},
                             {"lost", double(packets.lost)},
                             {"out_of_order", double(packets.outOfOrder)},
                             {"kernel_drops", double(counts.udp.kernelDrops)},
                             {"turns_dropped", double(counts.turnsDropped)},
                             {"wrong", double(wrong)}};
    const auto set = [&](HealthLevel level, const QString &message) {
        health().set("lidar", level, message, values);
    };
    const std::string receiveError = feed_.receiveError();
    if (source_ == Source::None)
        set(HealthLevel::Warn, "no source is open; source.open opens one");
    else if (!receiveError.empty() || !sourceError_.isEmpty())
        set(HealthLevel::Failed, receiveError.empty() ? sourceError_ : QString::fromStdString(receiveError));
    else if (source_ == Source::Ended)
        set(HealthLevel::Ok, sourceName_ + " has been played to its end");
    else if (source_ == Source::Live && sincePacket_.elapsed() > 3000)
        set(HealthLevel::Stale,
            QString("no packet on %1 for %2 s").arg(sourceName_).arg(sincePacket_.elapsed() / 1000));
    else if (packets.otherModel > 0)
        set(HealthLevel::Warn, velodyne::describe(velodyne::PacketFault::Model));
    else if (wrong > 0)
        set(HealthLevel::Warn, QString("%1 packets were no data packets of an HDL-32E").arg(wrong));
    else if (lost > 0)
        set(HealthLevel::Warn, "packets or turns were lost");
    else
        set(HealthLevel::Ok, "packets come from " + sourceName_);
}

void VelodyneLogger::updateRecordHealth() {
    const Recorder::Status status = recorder_.status();
    const QJsonObject values = recordStatus();
    if (!status.error.empty())
        health().set("recording", HealthLevel::Failed, QString::fromStdString(status.error), values);
    else if (status.dropped > 0)
        health().set("recording", HealthLevel::Warn, "the disk was too slow: packets are missing", values);
    else
        health().set("recording", HealthLevel::Ok,
                     status.recording ? "recording to " + QString::fromStdString(status.path)
                                      : "not recording",
                     values);
}

} // namespace hermes
