// What the Velodyne logger tells about itself: the topic lidar, status of source and recording, health.
#include "common/Time.h"
#include "daemons/velodynelogger/VelodyneLogger.h"
#include "protocol/nmea/UtcTime.h"

namespace hermes::velodynelogger {

namespace {

QString textOf(const SensorChoice::Sensor &sensor) {
    return QString::fromStdString(toText(sensor));
}

/// Which sensors are not decoded.
QString otherSensors(const LidarFeed::Counts &counts) {
    QStringList others;
    for (const SensorChoice::Sensor &sensor : counts.sensors) {
        if (!counts.decoded || toText(sensor) != toText(*counts.decoded))
            others += textOf(sensor);
    }
    return others.join(", ");
}

constexpr double longestBlindness_s = 3;
constexpr qint64 lately_ms = 3000;

bool isLately(const QElapsedTimer &since) {
    return since.isValid() && since.elapsed() < lately_ms;
}

/// What went wrong so far, after a semicolon each.
QString pastText(quint64 wrong, quint64 lost, const velodyne::GpsReader::Counts &gps) {
    QString text;
    if (wrong > 0)
        text += QString("; %1 packets were no data packets, expected are %2 bytes of an %3")
                    .arg(wrong)
                    .arg(velodyne::packetSize)
                    .arg(QString::fromStdString(velodyne::sensorNames()));
    if (lost > 0)
        text += QString("; %1 packets or turns were lost").arg(lost);
    if (gps.wrongValue + gps.badNmea > 0)
        text += QString("; of %1 position packets %2 had wrong values, %3 bad NMEA text")
                    .arg(gps.packets)
                    .arg(gps.wrongValue)
                    .arg(gps.badNmea);
    return text;
}

} // namespace

LidarGps VelodyneLogger::gpsState() const {
    const velodyne::GpsReader::State gps = feed_.gps();
    const velodyne::GpsReader::Counts counts = feed_.counts().gps;
    LidarGps state;
    if (counts.packets == 0)
        return state;
    state.pps = velodyne::toText(gps.packet.pps);
    state.nmea = QString::fromLatin1(gps.packet.nmea.data(), int(gps.packet.nmea.size()));
    state.valid = gps.valid;
    state.locked = gps.utc_ns.has_value();
    state.packets = counts.packets;
    state.wrongValue = counts.wrongValue;
    state.badNmea = counts.badNmea;
    if (gps.utc_ns)
        state.utc = double(*gps.utc_ns) * 1e-9;
    if (gps.position) {
        state.latitude_deg = gps.position->latitude_deg;
        state.longitude_deg = gps.position->longitude_deg;
    }
    return state;
}

LidarMessage VelodyneLogger::lidarState() const {
    const LidarFeed::Counts counts = feed_.counts();
    const velodyne::PacketCounts &packets = counts.packets;
    LidarMessage state;
    state.source = source_.status();
    if (counts.model)
        state.model = counts.model->name;
    if (counts.decoded)
        state.sensor = textOf(*counts.decoded);
    state.rpm = counts.rpm;
    state.packetRate_hz = packetRate_;
    state.gps = gpsState();
    state.packets = packets.packets;
    state.turns = counts.turns;
    state.lost = packets.lost;
    state.gaps = packets.gaps;
    state.outOfOrder = packets.outOfOrder;
    state.clockJumps = packets.clockJumps + counts.clockSteps;
    state.wrongSize = packets.wrongSize;
    state.wrongFlag = packets.wrongFlag;
    state.wrongValue = packets.wrongValue;
    state.otherModel = packets.otherModel;
    state.otherSensors = counts.otherSensors;
    state.positionPackets = counts.gps.packets;
    state.otherDatagrams = counts.other + counts.udp.tooLong;
    state.kernelDrops = counts.udp.kernelDrops;
    state.decoderDrops = counts.udp.decoderDrops;
    state.receiveBufferBytes = counts.udp.bufferBytes;
    state.turnsDropped = counts.turnsDropped;
    state.cloudsDropped = counts.cloudsDropped;
    state.recording = recording_.status();
    return state;
}

void VelodyneLogger::updateHealth() {
    updateSourceHealth(feed_.counts());
    if (source_.state() == State::Live && feed_.positionError())
        health().set("position packets", HealthLevel::Warn, QString::fromStdString(*feed_.positionError()));
    else
        health().remove("position packets");
}

/// Until none came for a while; in a replay it stays so.
bool VelodyneLogger::isOfOtherModel(const velodyne::PacketCounts &packets) const {
    return packets.otherModel > 0 &&
           (source_.state() != State::Live || !sinceOther_.isValid() || isLately(sinceOther_));
}

/// What sends, what the setting says, and what was expected.
QString VelodyneLogger::otherModelText(const LidarFeed::Counts &counts) {
    const velodyne::PacketCounts &packets = counts.packets;
    const auto byte = [](auto value) { return QString("%1 hex").arg(unsigned(value), 2, 16, QChar('0')); };
    const QString wanted = settings().text("decode.model");
    const velodyne::SensorModel *const model = velodyne::findSensorModel(packets.lastOther);
    const QString text =
        QString("%1 packets on %2 are not decoded: ").arg(packets.otherModel).arg(source_.name());
    if (!model || !velodyne::isDecoded(packets.lastOtherMode, packets.lastOther))
        return text +
               QString("a sensor of model %1 in return mode %2 sends; expected: ")
                   .arg(byte(packets.lastOther), byte(packets.lastOtherMode)) +
               QString::fromStdString(velodyne::decodedSensors());
    if (wanted != "auto" && wanted != model->key)
        return text + QString("a sensor of model %1 sends, decode.model is %2; expected are the sensor of "
                              "that setting, or the setting %3 or auto")
                          .arg(model->name, wanted, model->key);
    return text + QString("a sensor of model %1 sends, too; expected is one sensor on a port, decoded is %2")
                      .arg(model->name, counts.model ? counts.model->name : "another one");
}

void VelodyneLogger::updateSourceHealth(const LidarFeed::Counts &counts) {
    const velodyne::PacketCounts &packets = counts.packets;
    const std::uint64_t wrong = packets.wrong();
    const std::uint64_t lost = packets.lost + packets.outOfOrder + counts.udp.kernelDrops +
                               counts.udp.decoderDrops + counts.turnsDropped + counts.cloudsDropped;
    const QJsonObject values{{"packets", double(packets.packets)},
                             {"packet_rate_hz", packetRate_},
                             {"rpm", counts.rpm},
                             {"beams", double(counts.beams)},
                             {"beams_back", double(counts.beamsBack)},
                             {"lost", double(packets.lost)},
                             {"out_of_order", double(packets.outOfOrder)},
                             {"kernel_drops", double(counts.udp.kernelDrops)},
                             {"decoder_drops", double(counts.udp.decoderDrops)},
                             {"turns_dropped", double(counts.turnsDropped)},
                             {"clouds_dropped", double(counts.cloudsDropped)},
                             {"wrong", double(wrong)}};
    const auto set = [&](HealthLevel level, const QString &message) {
        health().set("lidar", level, message, values);
    };
    const QString sensors = QString::fromStdString(velodyne::sensorNames());
    const auto receiveError = feed_.receiveError();
    if (!unopened_.isEmpty())
        set(HealthLevel::Failed, unopened_ + "; it is tried again each second");
    else if (source_.state() == State::None)
        set(HealthLevel::Warn, "no source is open; source.open opens one");
    else if (receiveError || !source_.error().isEmpty())
        set(HealthLevel::Failed, receiveError ? QString::fromStdString(*receiveError) : source_.error());
    else if (source_.state() == State::Ended && (counts.decoded || counts.other + packets.otherModel == 0)) {
        const auto leftOut =
            QString::fromStdString(feed_.player().counts().leftOut(!counts.decoded.has_value()));
        set(counts.turns > 0 && leftOut.isEmpty() ? HealthLevel::Ok : HealthLevel::Warn,
            source_.name() + " has been played to its end" + (counts.turns > 0 ? "" : ", and gave no scan") +
                (leftOut.isEmpty() ? "" : "; " + leftOut));
    } else if (source_.state() == State::Live && sincePacket_.elapsed() > 3000)
        set(HealthLevel::Stale,
            QString("no packet on %1 for %2 s").arg(source_.name()).arg(sincePacket_.elapsed() / 1000));
    else if (counts.other > 0 && !counts.decoded)
        set(HealthLevel::Warn,
            QString("%1 datagrams came, and no data packet of an %2").arg(counts.other).arg(sensors));
    else if (isOfOtherModel(packets))
        set(isLately(sinceGood_) ? HealthLevel::Warn : HealthLevel::Failed, otherModelText(counts));
    else if (counts.otherSensors > 0 && !counts.decoded)
        set(HealthLevel::Warn, "no data packet is decoded, those that came are of " + otherSensors(counts));
    else if (counts.blind_s > longestBlindness_s)
        set(HealthLevel::Warn,
            QString("packets come from %1, but only %2 of %3 beams (of an eighth of the last turn) came "
                    "back, and under 1 % for %4 s; expected are 1 % at least: is the lidar covered?")
                .arg(source_.name())
                .arg(counts.beamsBack)
                .arg(counts.beams)
                .arg(counts.blind_s, 0, 'f', 0));
    else if (counts.otherSensors > 0)
        set(HealthLevel::Warn,
            textOf(*counts.decoded) + " is decoded, data packets come from " + otherSensors(counts) +
                QString(" too: %1 were left out; source.sender chooses").arg(counts.otherSensors));
    else if (counts.model && settings().integer("decode.laser") >= counts.model->lasers)
        set(HealthLevel::Warn, QString("decode.laser is %1, but a %2 has lasers 0 to %3: scans are empty")
                                   .arg(settings().integer("decode.laser"))
                                   .arg(counts.model->name)
                                   .arg(counts.model->lasers - 1));
    else {
        const HealthLevel level =
            faults_.level(double(wrong + lost + counts.gps.wrongValue + counts.gps.badNmea));
        const auto utc_ns = feed_.gps().utc_ns;
        const bool isRolledOver = utc_ns && source_.state() == State::Live &&
                                  nmea::isRolledOver(double(*utc_ns) * 1e-9, stampNow());
        const QString clock =
            counts.clock == velodyne::StampSource::Host && counts.turns > 0
                ? QString("; no GPS sets its clock: scans are stamped by this host's, to %1 ms")
                      .arg(double(counts.clockBound_ns) * 1e-6, 0, 'f', 1)
                : QString();
        set(isRolledOver && level == HealthLevel::Ok ? HealthLevel::Warn : level,
            "packets come from " + source_.name() + pastText(wrong, lost, counts.gps) + clock +
                (isRolledOver ? "; the date of the GPS is 1024 weeks off the clock (week roll-over)" : ""));
    }
}

} // namespace hermes::velodynelogger
