// What the serial logger offers: its settings, topics and commands.
#include "common/settings/SettingsTable.h"
#include "daemons/seriallogger/SerialLogger.h"
#include "protocol/wire/Fields.h"

namespace hermes::seriallogger {

void SerialLogger::declareSettings() {
    addSetting(PortSettings::field());
    settings().addRule(PortSettings::check);
    SettingsTable table;
    table.group("Recording", SettingsTable::Applies::OnRestart);
    table.define("record.queue_bytes", 4194304, // 45 s of 921,600 baud
                 "Bytes of each port that may wait for the disk", "byte", 4096, 1 << 30);
    table.declareIn(settings());
}

void SerialLogger::declareTopics() {
    addTopic(Topic("lines", "Each line of the ports with view lines or nmea").carries<LineMessage>());
    addTopic(Topic("fix", "Each fix of the ports with view nmea; null is what the receiver does not know")
                 .carries<FixMessage>());
    addTopic(
        Topic("serial", "State of ports and source, once a second").carries<SerialMessage>().snapshot([this] {
            return state();
        }));
}

void SerialLogger::declareSourceCommands() {
    addCommand(source_.openCommand("Shows lines and fixes of the ports, or of a recording; the ports are "
                                   "received and recorded all the same"));
    addCommands(source_.replayCommands());
    addCommand(Command("source.status", "What the topic serial says, now")
                   .needs(Role::Observer)
                   .answers([this](const Call &) { return state(); }));
}

void SerialLogger::declareCommands() {
    declareSourceCommands();
    addCommands(recording_.commands());
    addCommand(
        Command("record.export", "Makes a CSV of one port of a recording, beside it; the reply comes when it "
                                 "is complete")
            .param(Field::text("name", "Of the recording"))
            .param(Field::text("port", "Of the recording"))
            .param(Field::text("rows", "One for each line, for all bytes that came in together, or each fix")
                       .choices({"lines", "bytes", "fixes"})
                       .byDefault("lines"))
            .param(Field::boolean("force", "Replace the CSV of an earlier export").byDefault(false))
            .gives<ExportAnswer>()
            .example({{"name", "drive"}, {"port", "gps"}},
                     QJsonObject{{"path", "/data/drive/seriallogger-gps-lines.csv"}, {"rows", 4711}})
            .asyncHandler([this](const Call &call, const Reply &reply) { exportRecording(call, reply); }));
    addCommand(Command("ports.list", "State of each port, and what came from it")
                   .needs(Role::Observer)
                   .answers([this](const Call &) { return portList(); }));
    addCommand(Command("mark", "Puts a text with the time into the events of the recording")
                   .param(Field::text("text", "What to remember").with("maxLength", 1000))
                   .example({{"text", "at the door"}}, QJsonObject{{"stamp", 1.7e9}, {"mono", 4711.5}})
                   .answers([this](const Call &call) { return mark(call); }));
    addCommand(Command("record.marks", "The marks of a recording that has ended, the first 1000 of them")
                   .needs(Role::Observer)
                   .param(Field::text("name", "Of the recording"))
                   .gives<std::vector<RecordedMark>>()
                   .example({{"name", "drive"}},
                            QJsonArray{QJsonObject{{"t_s", 12.5}, {"stamp", 1.7e9}, {"text", "at the door"}}})
                   .asyncHandler([this](const Call &call, const Reply &reply) { listMarks(call, reply); }));
    addCommand(
        Command("send", "Sends bytes to the device of a port")
            .param(Field::text("port", "Which"))
            .param(Field::text("bytes", "Pairs of hexadecimal digits: \"B5 62 0A 04\"")
                       .with("maxLength", 65536)
                       .optional())
            .param(Field::text("text", "Instead of bytes; sent as UTF-8").with("maxLength", 65536).optional())
            .gives<SendAnswer>()
            .example({{"port", "gps"}, {"text", "$PMTK220,200*2C\r\n"}}, QJsonObject{{"sent", 17}})
            .asyncHandler([this](const Call &call, const Reply &reply) { send(call, reply); }));
}

} // namespace hermes::seriallogger
