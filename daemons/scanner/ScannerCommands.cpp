// What the scanner offers: its settings, topics and commands.
#include "common/interface/InterfaceRegistry.h"
#include "common/settings/SettingsTable.h"
#include "daemons/scanner/Scanner.h"
#include "protocol/wire/Fields.h"

namespace hermes::scanner {

void Scanner::declareSettings() {
    QStringList models{"auto"};
    for (const scan::ScannerModel &model : scan::scannerModels())
        models.append(model.name);
    SettingsTable table;
    table.group("Scanner", SettingsTable::Applies::OnRestart);
    table.define("scanner.url", "",
                 "Where it is: serial:///dev/serial/by-id/NAME, with ?baud=RATE only if that is not the "
                 "model's; tcp://HOST:PORT");
    table.define("scanner.model", "auto", "Which it is; auto: whichever is heard or answers on that line")
        .choices(models);
    table.declareIn(settings());
    settings().addRule([](const QJsonObject &values) -> std::vector<SchemaViolation> {
        const QString text = values["scanner"].toObject()["url"].toString();
        const Result<InterfaceUrl> url = InterfaceUrl::parse(text);
        const bool fits = url && ((url->scheme == "serial" && !url->path.isEmpty()) ||
                                  (url->scheme == "tcp" && !url->host.isEmpty() && url->port != 0));
        const QString model = values["scanner"].toObject()["model"].toString();
        const scan::ScannerModel *const told = scan::findScannerModel(model.toStdString());
        if (fits && told && url->scheme == "serial" && told->baud == 0)
            return {{"scanner.url", text, "tcp://HOST:PORT, as a " + model + " has no serial line"}};
        if (text.isEmpty() || fits)
            return {};
        return {{"scanner.url", text, "serial:///DEVICE or tcp://HOST:PORT, or nothing"}};
    });
}

void Scanner::declareTopics() {
    addTopic(Topic("scan2d", "Each revolution: its points, counter-clockwise, in the scanner's frame")
                 .carries<ScanMessage>());
    addTopic(Topic("scanner", "State of source, scanner and recording, once a second")
                 .carries<ScannerMessage>()
                 .snapshot([this] { return state(); }));
}

void Scanner::declareCommands() {
    addCommand(source_.openCommand("Shows what the scanner measures, or a recording; the scanner is read and "
                                   "recorded all the same"));
    addCommands(source_.replayCommands());
    addCommand(Command("source.status", "What the topic scanner says, now")
                   .needs(Role::Observer)
                   .answers([this](const Call &) { return state(); }));
    addCommands(recording_.commands());
    connect(&recording_, &Recording::changed, this,
            [this] { publish("scanner", [this] { return state(); }); });
}

} // namespace hermes::scanner
