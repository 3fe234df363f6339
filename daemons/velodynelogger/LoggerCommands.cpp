// What the Velodyne logger offers: its settings, topics and commands.
#include "common/files/FilesSetting.h"
#include "common/settings/SettingsTable.h"
#include "daemons/velodynelogger/VelodyneLogger.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"

namespace hermes::velodynelogger {

void VelodyneLogger::declareSettings() {
    QStringList models;
    for (const std::string &model : velodyne::modelChoices())
        models.append(QString::fromStdString(model));
    SettingsTable table;
    table.group("Source", SettingsTable::Applies::OnRestart);
    table.define("source.address", "0.0.0.0", "Local IPv4 address to receive on; 0.0.0.0 for all");
    table.define("source.port", velodyne::dataPort, "UDP port of the sensor's data packets").range(1, 65535);
    table
        .define("source.sender", "",
                "IPv4 address of the sensor; empty: the first that sends, and no other as long as it does")
        .with("pattern", "^$|^([0-9]{1,3}\\.){3}[0-9]{1,3}$");
    table
        .define("source.position_port", velodyne::positionPort,
                "UDP port of the sensor's position packets; 0: not received")
        .range(0, 65535);
    table.define("source.receive_buffer_bytes", 16777216, // for 3 s of packets, or 0.3 s of 20,000 a second
                 "Room the system keeps for packets not yet taken", "byte", 65536, 268435456);
    table.define("source.pcap", "", "Capture file to replay at the start instead of receiving");
    table.define("source.loop", false, "That replay begins anew at its end");
    table.define("source.speed", 1.0, "Of that replay: 1 real time, 0 as fast as possible without loss")
        .range(0, 1000);
    table.group("Decoding", SettingsTable::Applies::OnRestart);
    table
        .define("decode.laser", -1,
                "Laser whose ring is published; -1: the one nearest to the horizon (" +
                    QString::fromStdString(velodyne::horizonLasers()) + ")")
        .range(-1, velodyne::maxLasers() - 1);
    table.define("decode.model", "auto", "The sensor; auto: as its packets say (hdl32e where they do not)")
        .choices(models);
    table.define("decode.returns", "strongest", "Which returns of a sensor in dual return mode are taken")
        .choices({"strongest", "last", "both"});
    table.define("decode.vertical_offsets", true,
                 "Each laser's own height, as its sensor's documents tell it, is in z; false: all lasers lie "
                 "in the sensor's origin");
    table
        .define("decode.clock", "auto",
                "Whose clock stamps the scans: the sensor's, which a GPS sets; this host's; auto: the "
                "sensor's once a GPS has set it")
        .choices({"auto", "gps", "host"});
    table.define("decode.stamp_offset_s", 0.0, "Added to the stamps of scans", "s", -3600, 3600);
    table.group("Cloud");
    table
        .define("cloud.max_points", 8000,
                "Of a message of the topic cloud, about: firings are thinned evenly")
        .range(100, 20000);
    table.define("cloud.turn_step", 1, "Every n-th turn goes to the topic cloud").range(1, 1000);
    table.declareIn(settings());
    addSetting(namedFilesField());
    settings().addRule([](const QJsonObject &values) -> std::vector<SchemaViolation> {
        const QString sender = values["source"].toObject()["sender"].toString();
        if (sender.isEmpty() || addressFrom(sender.toStdString()))
            return {};
        return {{"source.sender", sender, "an IPv4 address, as 192.168.1.201, or nothing"}};
    });
}

void VelodyneLogger::declareTopics() {
    addTopic(Topic("scan2d", "Each turn of one laser: its points, counter-clockwise, in the sensor's frame")
                 .carries<ScanMessage>());
    addTopic(Topic("cloud",
                   "Each turn of all lasers, thinned by the settings cloud.*: points in the sensor's frame")
                 .carries<CloudMessage>());
    addTopic(Topic("lidar", "State of source, sensor and recording, once a second")
                 .carries<LidarMessage>()
                 .snapshot([this] { return lidarState(); }));
}

void VelodyneLogger::declareSourceCommands() {
    addCommand(
        source_
            .openCommand("Receives live, or replays a capture file or a recording; what was open is closed")
            .param(Field::text("pcap",
                               "Capture file to replay, pcap or pcapng; a relative path begins in the "
                               "folder in which the logger runs")
                       .with("x-role", toString(Role::Engineer))
                       .optional())
            .param(Field::integer("port", "Of the replay only the sensor that sends to this port is decoded")
                       .range(1, 65535)
                       .optional())
            .param(Field::boolean("loop", "The replay begins anew at its end").byDefault(false)));
    addCommand(Command("source.close", "Stops receiving or replaying").answers([this](const Call &) {
        const Result<void> fine = source_.mayChange();
        if (fine)
            closeSource();
        return fine;
    }));
    addCommands(source_.replayCommands());
    addCommand(Command("source.status", "What the topic lidar says, now")
                   .needs(Role::Observer)
                   .answers([this](const Call &) { return lidarState(); }));
    addCommand(
        Command("capture.turn",
                "Writes the next complete turn of all lasers to a file in the folder of recordings")
            .param(Field::text("name", "Of the file, without path"))
            .param(Field::text("format", "Of the file").choices({"csv", "pcd", "ply"}).byDefault("csv"))
            .gives<CapturedTurn>()
            .example({{"name", "hall"}}, QJsonObject{{"path", "/data/hall.csv"}, {"points", 60123}})
            .asyncHandler([this](const Call &call, const Reply &reply) { captureTurn(call, reply); }));
}

void VelodyneLogger::declareRecordCommands() {
    addCommands(recording_.commands());
    connect(&recording_, &Recording::changed, this,
            [this] { publish("lidar", [this] { return lidarState(); }); });
}

} // namespace hermes::velodynelogger
